// SPDX-License-Identifier: Apache-2.0
// The driver on a Cortex-M3, over a bus that is plain RAM: it is initialised, started, asked and answers.
#include <dpchip/driver/vpc3.hpp>

using namespace dpchip::driver;

std::uint8_t ram[2048];

struct App : Events {
    int prms = 0;
    Verdict set_prm(const dpchip::dp::SetPrm& prm) { return ++prms, prm.user_octet(0) == 7 ? Verdict::accept : Verdict::refuse; }
};

constexpr std::uint8_t kCfg[]{0x11, 0x21};
constexpr PrmConstant kConstants[]{{0, 0xF0, 0x00}};

int main() {
    App app;
    Vpc3<MemoryMappedBus, App> drv{MemoryMappedBus{reinterpret_cast<std::uintptr_t>(ram)}, app};
    const Config config{.address = 8, .ident = 0x4711, .cfg = kCfg, .max_prm = 20, .max_diag = 20,
                        .prm_rules = {1, 8, kConstants, {}}, .fail_safe = true};
    if (drv.configure(config) != ConfigError::none || !drv.start()) return 1;
    if (ram[0x16] != 8 || ram[0x1A] != 2 || ram[drv.layout().address(ram[0x34])] != 0x11) return 2;
    ram[0x01] = 0x08;  // New_Prm_Data
    ram[0x2F] = 8;
    ram[drv.layout().address(ram[0x30]) + 7] = 7;
    drv.on_interrupt();
    if (app.prms != 1 || ram[0x08] != 0x02) return 3;
    ram[0x0C] = 0x01;  // diagnosis buffer 1 is the user's
    const std::uint8_t ext[]{2, 0x55};
    if (drv.set_diagnosis(ext, {.ext_diag = true}) != DiagResult::handed_over || ram[0x24] != 8) return 4;
    return 0;
}
