// SPDX-License-Identifier: Apache-2.0
// The start-up to data exchange with nothing but pins: the driver's accesses are bus cycles, telegrams are levels at RXD and
// TXD. It ends as at telegram level, in all four processor modes, with 2 KB and on a 4 KB board.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <string>
#include <vector>

#include <dpchip/driver/bus_port.hpp>
#include <dpchip/fdl/baud.hpp>
#include <dpchip/pins/bit_line.hpp>
#include <dpchip/pins/bus_cycles.hpp>
#include <dpchip/regmap/address.hpp>
#include <dpchip/regmap/organizational_parameters.hpp>
#include <dpchip/segment/port.hpp>
#include <dpchip/trace/pin_finding_text.hpp>

#include "support/startup_firmware.hpp"

namespace {

using namespace dpchip;
using core::Ticks;
using pins::PinId;
using pins::PinLevel;
using regmap::ProcessorMode;
using regmap::Supply;
namespace startup = test::startup;

static_assert(driver::BusPort<pins::BusCycles<>::Port>, "the driver runs on these bus cycles");
static_assert(pins::BitStation<pins::Package<>>);

/// A board: the package, a processor on its bus, and a master at the other end of the line.
class Board {
public:
    Board(ProcessorMode mode, bool with_ab11, Supply supply, const pins::PackageOptions& package_options = {})
        : package_{regmap::Variant::vpc3c, supply, options(), package_options}, bus_{package_, mode, with_ab11}, firmware_{{this, &Board::read, &Board::write}, startup::Service::interrupt} {
        line_.attach(package_);
        line_.attach(adapter_);
        bus_.set_mover([](void* self, Ticks to) { static_cast<Board*>(self)->line_.advance(to); }, this);
        bus_.power_up();
        begun_ = firmware_.begin();
    }

    startup::Result run() {
        EXPECT_TRUE(begun_);
        for (const startup::Request& request : startup::requests()) {
            run_to(Ticks{request.at});
            EXPECT_TRUE(master_.send_at(Ticks{request.at}, request.octets));
            result_.telegrams.push_back({request.at, true, request.octets});
        }
        run_to(Ticks{startup::kEnd});
        bus_.settle();
        for (std::size_t i = 0; i < startup::kMemory; ++i) result_.memory[i] = package_.chip().peek(on_bus(static_cast<std::uint16_t>(i)));
        std::sort(result_.telegrams.begin(), result_.telegrams.end(), [](const auto& a, const auto& b) { return a.start < b.start; });
        EXPECT_TRUE(firmware_.exchanging());
        return result_;
    }
    pins::Package<>& package() { return package_; }
    int transmissions() const { return transmissions_; }
    int txd_edges() const { return txd_edges_; }
    /// The processor reads the RAM from `at` on, whenever it has nothing else to do.
    void keep_bus_busy_from(Ticks at) { busy_from_ = at; }

private:
    static regmap::Options options() {
        regmap::Options o;
        for (const auto& [name, value] : startup::kOptions) EXPECT_TRUE(regmap::set_option(o, name, value));
        return o;
    }
    /// The scenario's firmware is an Intel one: on a Motorola bus its word registers have their octets in the other order.
    std::uint16_t on_bus(std::uint16_t address) const { return regmap::motorola(bus_.mode()) ? regmap::motorola_address(address) : address; }
    static std::uint8_t read(void* self, std::uint16_t address) {
        auto& board = *static_cast<Board*>(self);
        return board.bus_.read(board.on_bus(address));
    }
    static void write(void* self, std::uint16_t address, std::uint8_t value) {
        auto& board = *static_cast<Board*>(self);
        board.bus_.write(board.on_bus(address), value);
    }
    bool interrupt() const { return package_.pin(PinId::x_int) == PinLevel::low; }

    /// TXD is driven within RTS and high-resistance, or pulled up, outside.
    void note(const pins::PinEdge& e) {
        if (e.pin == PinId::rts) {
            rts_ = e.level == PinLevel::high;
            if (rts_) ++transmissions_;
        }
        if (e.pin != PinId::txd) return;
        ++txd_edges_;
        const PinLevel idle = package_.options().txd_pull_up ? PinLevel::high : PinLevel::z;
        EXPECT_TRUE(rts_ || e.level == idle) << e.at.n;
    }

    void run_to(Ticks end) {
        while (line_.now() < end) {
            if (line_.now() >= busy_from_ && end - line_.now() > core::microseconds(1)) static_cast<void>(bus_.read(0x7F0));
            else line_.advance(std::min(end, std::max(line_.next(), line_.now() + Ticks{1})));
            while (!package_.edges().empty()) note(package_.edges().pop());
            if (interrupt()) firmware_.on_interrupt();
            while (master_.pending()) {
                const segment::Transmission t = master_.receive();
                result_.telegrams.push_back({t.start.n, false, startup::Octets(t.bytes().begin(), t.bytes().end())});
            }
        }
    }

    pins::BitLine line_;
    pins::Package<> package_;
    segment::Port master_{*fdl::baud_from_bits_per_s(startup::kBaud)};
    pins::TelegramAdapter<segment::Port> adapter_{master_, *fdl::baud_from_bits_per_s(startup::kBaud)};
    pins::BusCycles<> bus_;
    startup::Firmware firmware_;
    bool begun_ = false;
    Ticks busy_from_ = core::kNever;
    bool rts_ = false;
    int transmissions_ = 0, txd_edges_ = 0;
    startup::Result result_;
};

struct Way {
    ProcessorMode mode;
    bool with_ab11;
    Supply supply;
};

/// The master's telegrams are where they were. An answer comes within a quarter bit: where the grid of samples lies depends
/// on when the driver wrote Start, which takes bus cycles here.
void compare_times(const std::vector<startup::Seen>& is, const std::vector<startup::Seen>& reference) {
    const startup::Ticks quarter = fdl::baud(*fdl::baud_from_bits_per_s(startup::kBaud)).bit.n / 4;
    ASSERT_EQ(is.size(), reference.size());
    for (std::size_t i = 0; i < is.size(); ++i) {
        const startup::Ticks late = is[i].start - reference[i].start, most = is[i].own ? 0 : quarter;
        EXPECT_TRUE(late >= 0 && late <= most) << "telegram " << i << " is " << late << " ticks late";
    }
}

std::string findings(pins::Package<>& package) {
    std::string all;
    while (!package.findings().empty()) {
        const core::Finding f = package.findings().pop();
        all += trace::pin_finding_text(f.rule, f.detail) + '\n';
    }
    return all;
}

class StartUp : public testing::TestWithParam<Way> {};

// proves: VPC3C 1-01, VPC3C 2.1-01, VPC3C 2.1-09, VPC3C 8.1.2-01, VPC3C 8.1.2-03..06, VPC3C 9.1-01, APC3 6.1-01, E034
TEST_P(StartUp, Through_pins_ends_as_at_telegram_level) {
    const Way way = GetParam();
    Board board{way.mode, way.with_ab11, way.supply};
    const startup::Result is = board.run();
    const startup::Result reference = startup::telegram_level(startup::Service::interrupt);
    EXPECT_EQ(startup::difference(is.without_times(), reference.without_times()), "");
    compare_times(is.telegrams, reference.telegrams);
    EXPECT_EQ(board.package().violations(0), 0u);
    EXPECT_EQ(findings(board.package()), "");
    EXPECT_TRUE(board.package().chip().findings().empty());
    EXPECT_EQ(board.package().pin(PinId::xdataexch_sync), PinLevel::low) << "the LED of DATA-EXCH";
}

// proves: VPC3C 3.1-06, VPC3C 9.1-01, VPC3C 9.1-03, VPC3C 10.4-01
TEST(Txd, Without_its_pull_up_floats_between_transmissions_and_is_reported_once) {
    Board with{ProcessorMode::async_intel, false, Supply::v5}, without{ProcessorMode::async_intel, false, Supply::v5, {.txd_pull_up = false}};
    EXPECT_EQ(with.run().telegrams, without.run().telegrams) << "this line has a termination that holds it high";
    EXPECT_EQ(findings(with.package()), "");
    const std::string found = findings(without.package());
    EXPECT_EQ(found.substr(0, 20), "txd_floats at pin 26");
    EXPECT_EQ(std::count(found.begin(), found.end(), '\n'), 1);
    EXPECT_EQ(without.package().pin(PinId::txd), PinLevel::z);
    EXPECT_EQ(with.package().pin(PinId::txd), PinLevel::high);
    EXPECT_EQ(with.transmissions(), static_cast<int>(startup::answers()));
    EXPECT_EQ(without.transmissions(), with.transmissions());
    EXPECT_EQ(without.txd_edges(), with.txd_edges() + 2 * with.transmissions()) << "Z to 1 and 1 to Z, each time";
}

// proves: VPC3C 8.2-01, VPC3C 8.2-02
TEST(DualPort, A_processor_that_never_leaves_the_RAM_alone_delays_nothing_on_the_line) {
    Board board{ProcessorMode::async_intel, false, Supply::v5};
    board.keep_bus_busy_from(Ticks{41 * startup::kMillisecond});
    const startup::Result is = board.run(), reference = startup::telegram_level(startup::Service::interrupt);
    EXPECT_EQ(startup::difference(is.without_times(), reference.without_times()), "");
    compare_times(is.telegrams, reference.telegrams);
    const pins::DpcCounters& c = board.package().dpc();
    EXPECT_GT(c.collisions, 0u);
    EXPECT_LT(c.collisions, c.sequencer_accesses);
    EXPECT_LT(c.longest_wait * 5, 44u) << "less than a fifth of a character at 12 Mbit/s";
    std::printf("  %llu RAM cycles of the processor, %llu of the Micro Sequencer, which waited %llu CLK, at most %u at a time\n",
                static_cast<unsigned long long>(c.bus_accesses), static_cast<unsigned long long>(c.sequencer_accesses),
                static_cast<unsigned long long>(c.collisions), c.longest_wait);
}

INSTANTIATE_TEST_SUITE_P(Modes, StartUp, testing::Values(
    Way{ProcessorMode::async_intel, false, Supply::v3_3}, Way{ProcessorMode::async_intel, true, Supply::v5},
    Way{ProcessorMode::sync_intel, false, Supply::v5}, Way{ProcessorMode::sync_intel, true, Supply::v3_3},
    Way{ProcessorMode::async_motorola, false, Supply::v3_3}, Way{ProcessorMode::async_motorola, true, Supply::v5},
    Way{ProcessorMode::sync_motorola, false, Supply::v5}, Way{ProcessorMode::sync_motorola, true, Supply::v3_3}),
    [](const auto& i) {
        std::string name{regmap::name(i.param.mode)};
        std::replace(name.begin(), name.end(), '-', '_');
        return name + (i.param.with_ab11 ? "_on_a_4KB_board" : "_on_a_2KB_board");
    });

}  // namespace
