// SPDX-License-Identifier: Apache-2.0
// A stranger's program: decodes one telegram with dpchip::fdl.

#include <cstdint>

#include <dpchip/fdl/telegram.hpp>
#include <dpchip/version.h>

int main() {
    constexpr std::uint8_t fdl_status_request[]{0x10, 0x02, 0x63, 0x49, 0xAE, 0x16};
    const auto telegram = dpchip::fdl::decode(fdl_status_request);
    return telegram && telegram->da == 0x02 && telegram->sa == 0x63 && DPCHIP_VERSION_MAJOR >= 0 ? 0 : 1;
}
