// SPDX-License-Identifier: Apache-2.0
// The chip as a module: transactions into processor cycles, edges into signals.
#include <dpchip/tlm/chip.hpp>

#include <algorithm>
#include <array>

#include <dpchip/tlm/report.hpp>

namespace dpchip::tlm {

namespace {

constexpr std::uint8_t kNobodyDrives = 0xFF;

/// Octets of one beat: from there on addresses start again.
std::uint64_t beat(const ::tlm::tlm_generic_payload& p) { return std::min(p.get_streaming_width(), p.get_data_length()); }

bool enabled(const ::tlm::tlm_generic_payload& p, unsigned i) {
    const unsigned char* enables = p.get_byte_enable_ptr();
    return enables == nullptr || enables[i % p.get_byte_enable_length()] == TLM_BYTE_ENABLED;
}

}  // namespace

// ---- the module --------------------------------------------------------------------------------------------------

Chip::Chip(const sc_core::sc_module_name& name, const ChipSettings& settings)
    : sc_core::sc_module{name}, settings_{settings}, chip_{dpchip_chip_create(settings.variant.c_str())} {
    using SC_CURRENT_USER_MODULE = Chip;
    dpchip_chip* chip = chip_.get();
    if (chip == nullptr) report::error(report::kChip, *this, dpchip_last_error());
    if (settings.window.stride == 0) report::error(report::kChip, *this, "the stride of the window is 0");
    for (const auto& [option, value] : settings.options)
        if (dpchip_chip_set_option(chip, option.c_str(), value.c_str()) != DPCHIP_OK) report::error(report::kChip, *this, dpchip_last_error());
    dpchip_chip_set_bus_mode(chip, settings.format == DataFormat::motorola ? DPCHIP_MOTOROLA : DPCHIP_INTEL);
    dpchip_chip_set_access_time(chip, 0);  // time is the kernel's; cycles are annotated
    dpchip_chip_watch(chip, 1);

    bus.register_b_transport(this, &Chip::b_transport);
    bus.register_transport_dbg(this, &Chip::transport_dbg);
    bus.register_get_direct_mem_ptr(this, &Chip::get_direct_mem_ptr);
    x_int.initialize(true);
    xdataexch_sync.initialize(true);
    SC_METHOD(drive_outputs);
    dont_initialize();
    sensitive << output_due_;
}

Chip::~Chip() = default;

void Chip::before_end_of_elaboration() {
    if (line.bind_count() != 0) return;
    own_line_ = std::make_unique<Line>("own_line");
    line(*own_line_);
}

void Chip::end_of_elaboration() {
    using SC_CURRENT_USER_MODULE = Chip;
    line->attach(*chip_, *this);
    if (reset.size() != 0) {
        SC_METHOD(follow_reset);
        sensitive << reset[0]->value_changed_event();
    }
    if (xcts.size() != 0) {
        SC_METHOD(follow_xcts);
        sensitive << xcts[0]->value_changed_event();
    }
}

dpchip_chip_info Chip::info() const {
    dpchip_chip_info info{};
    info.size = sizeof info;
    dpchip_chip_get_info(chip_.get(), &info);
    return info;
}

// ---- the bus -----------------------------------------------------------------------------------------------------

/// TLM-2.0 (IEEE 1666) 14.17: what a target must refuse, before anything has happened.
::tlm::tlm_response_status Chip::judge(const Payload& p) const {
    if (p.get_data_length() == 0 || p.get_streaming_width() == 0) return ::tlm::TLM_BURST_ERROR_RESPONSE;
    if (p.get_data_ptr() == nullptr) return ::tlm::TLM_GENERIC_ERROR_RESPONSE;
    if (const unsigned char* enables = p.get_byte_enable_ptr()) {
        const unsigned char* end = enables + p.get_byte_enable_length();
        const auto known = [](unsigned char e) { return e == TLM_BYTE_ENABLED || e == TLM_BYTE_DISABLED; };
        if (enables == end || !std::all_of(enables, end, known)) return ::tlm::TLM_BYTE_ENABLE_ERROR_RESPONSE;
    }
    return settings_.window.holds(p.get_address(), beat(p)) ? ::tlm::TLM_OK_RESPONSE : ::tlm::TLM_ADDRESS_ERROR_RESPONSE;
}

void Chip::b_transport(Payload& payload, sc_core::sc_time& delay) {
    payload.set_dmi_allowed(false);
    if (payload.get_command() == ::tlm::TLM_IGNORE_COMMAND) return payload.set_response_status(::tlm::TLM_OK_RESPONSE);
    const ::tlm::tlm_response_status status = judge(payload);
    if (status == ::tlm::TLM_OK_RESPONSE)
        for (unsigned i = 0; i < payload.get_data_length(); ++i)
            if (enabled(payload, i)) access(payload, i, delay);
    payload.set_response_status(status);
}

/// One 8-bit processor cycle, for octet `i` of the transaction.
void Chip::access(Payload& payload, unsigned i, sc_core::sc_time& delay) {
    unsigned char& octet = payload.get_data_ptr()[i];
    const std::uint64_t address = payload.get_address() + i % beat(payload);
    if (settings_.synchronisation == Synchronisation::exact && delay != sc_core::SC_ZERO_TIME) {
        sc_core::wait(delay);
        delay = sc_core::SC_ZERO_TIME;
    }
    if (!settings_.window.selects(address) || held()) {
        if (payload.is_read()) octet = kNobodyDrives;
        if (settings_.window.selects(address)) delay += settings_.access_time;
        return;
    }
    line->advance(to_ticks(sc_core::sc_time_stamp() + delay));
    if (payload.is_read()) octet = dpchip_chip_read(chip_.get(), settings_.window.chip_address(address));
    else dpchip_chip_write(chip_.get(), settings_.window.chip_address(address), octet);
    line->touched();
    delay += settings_.access_time;
}

/// Reads what lies inside the window; writes nothing, because every register write acts.
unsigned Chip::transport_dbg(Payload& payload) {
    if (!payload.is_read() || payload.get_data_ptr() == nullptr) return 0;
    line->advance(to_ticks(sc_core::sc_time_stamp()));
    line->touched();
    unsigned i = 0;
    for (; i < payload.get_data_length() && settings_.window.holds(payload.get_address() + i, 1); ++i) {
        const std::uint64_t address = payload.get_address() + i;
        payload.get_data_ptr()[i] = settings_.window.selects(address) ? peek(settings_.window.chip_address(address)) : kNobodyDrives;
    }
    return i;
}

bool Chip::get_direct_mem_ptr(Payload&, ::tlm::tlm_dmi& dmi) {
    dmi.init();
    dmi.allow_read_write();
    return false;
}

// ---- pins --------------------------------------------------------------------------------------------------------

void Chip::line_moved() {
    dpchip_edge edge{};
    bool more = false;
    for (; dpchip_chip_edge(chip_.get(), &edge) == 1; more = true) edges_.push_back({to_sc_time(edge.ticks), edge.output, edge.level != 0});
    if (more) plan_outputs();
    std::array<char, 256> text{};
    while (dpchip_chip_finding(chip_.get(), text.data(), text.size()) == 1) report::warning(report::kFinding, *this, text.data());
}

void Chip::plan_outputs() {
    if (edges_.empty()) return;
    const sc_core::sc_time &now = sc_core::sc_time_stamp(), &at = edges_.front().at;
    output_due_.notify(at > now ? at - now : sc_core::SC_ZERO_TIME);
}

void Chip::drive_outputs() {
    for (; !edges_.empty() && edges_.front().at <= sc_core::sc_time_stamp(); edges_.pop_front()) {
        const Edge& edge = edges_.front();
        if (edge.output == DPCHIP_OUT_X_INT) x_int.write(edge.level);
        if (edge.output == DPCHIP_OUT_XDATAEXCH_SYNC) xdataexch_sync.write(edge.level);
    }
    plan_outputs();
}

void Chip::changed() {
    line->advance(to_ticks(sc_core::sc_time_stamp()));
    line->touched();
    const sc_core::sc_time now = edges_.empty() ? sc_core::sc_time_stamp() : edges_.back().at;
    for (const int output : {DPCHIP_OUT_X_INT, DPCHIP_OUT_XDATAEXCH_SYNC})
        edges_.push_back({now, output, dpchip_chip_level(chip_.get(), output) == 1});
    plan_outputs();
}

void Chip::follow_reset() {
    if (!held()) return;
    line->advance(to_ticks(sc_core::sc_time_stamp()));
    dpchip_chip_reset(chip_.get());
    line->touched();
}

void Chip::follow_xcts() {
    line->advance(to_ticks(sc_core::sc_time_stamp()));
    dpchip_chip_set_xcts(chip_.get(), xcts[0]->read() ? 1 : 0);
    line->touched();
}

}  // namespace dpchip::tlm
