// SPDX-License-Identifier: Apache-2.0
// The driver on a Cortex-M3, over a bus that is plain RAM: it is initialised, started, asked and answers.
#include <dpchip/driver/dpv1.hpp>
#include <dpchip/driver/dxb_subscriber.hpp>
#include <dpchip/driver/isochron.hpp>
#include <dpchip/driver/redundancy.hpp>
#include <dpchip/driver/slave_clock.hpp>
#include <dpchip/driver/vpc3.hpp>

using namespace dpchip::driver;

std::uint8_t ram[2048];

struct App : Events {
    int prms = 0;
    Verdict set_prm(const dpchip::dp::SetPrm& prm) { return ++prms, prm.user_octet(0) == 7 ? Verdict::accept : Verdict::refuse; }
};

constexpr std::uint8_t kCfg[]{0x11, 0x21};
constexpr PrmConstant kConstants[]{{0, 0xF0, 0x00}};

struct AcyclicApp : AcyclicEvents {
    RecordAnswer read(const RecordCall& call, std::span<std::uint8_t> out) {
        if (call.slot != 1) return refused(dpchip::dp::ErrorCode1::invalid_slot);
        out[0] = 0x55;
        return answered(1);
    }
};

/// An Initiate on SAP 49 and a DS_Read on the SAP that it was given, as the chip would leave them in RAM.
static int with_dpv1() {
    static AcyclicApp app;
    static Vpc3<MemoryMappedBus, AcyclicApp, 1, Dpv1<2, 4>> drv{MemoryMappedBus{reinterpret_cast<std::uintptr_t>(ram)}, app};
    for (std::uint8_t& octet : ram) octet = 0;
    const Config config{.address = 8, .ident = 0x4711, .cfg = kCfg, .max_prm = 20, .max_diag = 32, .test_ram = false,
                        .dpv1 = {.ms1 = true, .connections = 2, .ms2_max_data = 64, .alarms = 0xFC, .max_alarm = 8}};
    if (drv.configure(config) != ConfigError::none || !drv.start()) return 5;
    const AcyclicLayout& l = drv.dpv1().layout();
    const auto buffer = [&](std::uint8_t ch) { return &ram[l.address(l.request_buffer(ch))]; };
    constexpr std::uint8_t connection = channel::connection0, initiate[]{0x57, 0, 0, 0, 0, 100, 1, 0, 0, 0, 0, 0, 0, 2, 0, 2, 0, 0, 0, 0};
    std::uint8_t* at = buffer(channel::resource_manager);
    for (std::uint8_t i = 0; i < sizeof initiate; ++i) at[4 + i] = initiate[i];
    at[2] = sizeof initiate;
    at[0] = 0xC0;
    ram[l.entry(channel::resource_manager) + 1] = 0x82;
    ram[l.entry(channel::resource_manager) + 2] = 0x32;
    ram[0x01] = 0x80;  // FDL_Ind
    drv.on_interrupt();
    at = buffer(connection);
    if (at[0] != 0xA0 || at[2] != 16 || at[4] != 0x57 || ram[l.entry(connection) + 1] != 0x82) return 6;
    at[0] = 0x00;
    ram[l.entry(connection)] |= 0x80;
    ram[0x01] = 0x40;  // Poll_End_Ind
    drv.on_interrupt();
    at[4] = 0x5E, at[5] = 1, at[6] = 2, at[7] = 8, at[2] = 4;
    at[0] = 0xC0;
    ram[0x01] = 0x80;
    drv.on_interrupt();
    if (at[0] != 0xA0 || at[2] != 5 || at[8] != 0x55) return 7;
    ram[0x01] = 0;
    drv.tick(4000);  // the rate is not known: the longest Send_Timeout
    if (at[2] != 3 || at[4] != 0x58 || at[6] != 0x13) return 8;
    return 0;
}

/// A link, its sample, a time: what the chip would leave in RAM, and what becomes of it.
static int with_dpv2() {
    static App app;
    static Vpc3<MemoryMappedBus, App> drv{MemoryMappedBus{reinterpret_cast<std::uintptr_t>(ram)}, app};
    const MemoryMappedBus bus{reinterpret_cast<std::uintptr_t>(ram)};
    for (std::uint8_t& octet : ram) octet = 0;
    if (drv.configure({.address = 8, .ident = 0x4711, .cfg = kCfg, .test_ram = false}) != ConfigError::none) return 9;
    static DxbSubscriber<MemoryMappedBus> dxb{bus};
    static SlaveClock<MemoryMappedBus> clock{bus};
    if (!dxb.configure({29, 8}, drv.layout(), drv.layout().used_bytes, 2048 - 32) || !clock.configure(drv.layout(), BusMode::intel)) return 10;
    constexpr std::uint8_t prm[]{9, 3, 0, 0, 1, 9, 4, 1, 2, 8, 2, 0, 0x28, 0x02, 0, 0, 0};
    dpchip::dp::PrmBlockWalker walker{prm};
    dpchip::dp::PrmBlock block;
    if (!walker.next(block) || dxb.add(block, true) != dpchip::dp::DxbError::none || ram[0x35] != 4 || ram[drv.layout().address(ram[0x36])] != 9) return 11;
    std::uint8_t* const n = &ram[drv.layout().address(ram[0x23])];
    n[0] = 9, n[1] = 2, n[2] = 0x22, n[3] = 0x33;
    ram[0x13] = 0x05;  // new, in DXBout_Buf 1
    DxbSample sample;
    if (dxb.serve(0x0080) != 0x0080 || !dxb.fetch(sample) || sample.publisher != 9 || sample.octets.size() != 2 || sample.octets[1] != 0x33) return 12;
    RedundantHalf half;
    walker.next(block);
    if (half.command(*dpchip::dp::decode_prm_cmd(block)).seq_nr != 5 || half.role() != Role::primary) return 13;
    clock.start({.interval = 100});
    ram[0x7E0] = 0x01, ram[0x7E4] = 0xC3, ram[0x7EF] = 250;
    if (clock.serve(1, [] { return std::uint64_t{1'000'000}; }) != ClockEvent::set || clock.now(2'000'000).seconds != 0xC3000000u) return 14;
    SynchMeter meter;
    meter.expect(1000, 10);
    return meter.observe(0) && meter.observe(1005) && !meter.observe(2100) ? 0 : 15;
}

int main() {
    if (const int code = with_dpv2(); code != 0) return code;
    for (std::uint8_t& octet : ram) octet = 0;
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
    ram[0x0C] = ram[0x04] = 0;
    return with_dpv1();
}
