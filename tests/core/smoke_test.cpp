#include <dpchip/core/ticks.hpp>
#include <dpchip/core/result.hpp>
#include <dpchip/core/bits.hpp>
#include <dpchip/core/fixed_queue.hpp>
#include <dpchip/core/trace.hpp>
#include <dpchip/core/clock.hpp>
#include <dpchip/core/archive.hpp>
#include <dpchip/core/finding.hpp>
#include <dpchip/fdl/bus_times.hpp>
#include <dpchip/fdl/telegram.hpp>
#include <dpchip/fdl/transmission.hpp>
#include <dpchip/segment/station.hpp>
using namespace dpchip::core::literals;
static_assert((6.25_ns).n==375 && (136.7_ns).n==8202);
constexpr std::uint8_t k[]{0x10, 0x22, 0x02, 0x49, 0x6D, 0x16};
static_assert(dpchip::fdl::decode(k) && dpchip::fdl::decode(k)->da == 0x22);

