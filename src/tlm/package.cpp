// SPDX-License-Identifier: Apache-2.0
// The package: ports against pins, and when the kernel has to come back.
#include <dpchip/tlm/package.hpp>

#include <array>

#include <dpchip/tlm/report.hpp>

namespace dpchip::tlm {

namespace {

using sc_dt::sc_logic;

int from_logic(const sc_logic& value) {
    if (value == sc_dt::SC_LOGIC_0) return DPCHIP_LOW;
    return value == sc_dt::SC_LOGIC_1 ? DPCHIP_HIGH : DPCHIP_Z;
}

const sc_logic& to_logic(int level) {
    if (level == DPCHIP_Z) return sc_dt::SC_LOGIC_Z;
    return level == DPCHIP_HIGH ? sc_dt::SC_LOGIC_1 : sc_dt::SC_LOGIC_0;
}

}  // namespace

// ---- elaboration -------------------------------------------------------------------------------------------------

Package::Package(const sc_core::sc_module_name& name, const PackageSettings& settings)
    : sc_core::sc_module{name}, part_{dpchip_pins_create(settings.variant.c_str(), settings.millivolts)} {
    using SC_CURRENT_USER_MODULE = Package;
    dpchip_pins* part = part_.get();
    if (part == nullptr) report::error(report::kPackage, *this, dpchip_last_error());
    for (const auto& [option, value] : settings.options)
        if (dpchip_pins_set_option(part, option.c_str(), value.c_str()) != DPCHIP_OK) report::error(report::kPackage, *this, dpchip_last_error());
    if (dpchip_pins_set_clock_phase(part, settings.clock_phase) != DPCHIP_OK) report::error(report::kPackage, *this, dpchip_last_error());
    list_pins();
    SC_METHOD(step);
    sensitive << wake_;
    for (const Input& input : inputs_) sensitive << *input.port;
    for (const Data& data : data_) sensitive << *data.port;
}

Package::~Package() = default;

void Package::list_pins() {
    static constexpr std::array<int, 11> kAb{DPCHIP_PIN_AB0, DPCHIP_PIN_AB1, DPCHIP_PIN_AB2, DPCHIP_PIN_AB3, DPCHIP_PIN_AB4, DPCHIP_PIN_AB5,
                                             DPCHIP_PIN_AB6, DPCHIP_PIN_AB7, DPCHIP_PIN_AB8, DPCHIP_PIN_AB9, DPCHIP_PIN_AB10};
    static constexpr std::array<int, 8> kDb{DPCHIP_PIN_DB0, DPCHIP_PIN_DB1, DPCHIP_PIN_DB2, DPCHIP_PIN_DB3,
                                            DPCHIP_PIN_DB4, DPCHIP_PIN_DB5, DPCHIP_PIN_DB6, DPCHIP_PIN_DB7};
    inputs_ = {{DPCHIP_PIN_XINT_MOT, &xint_mot, DPCHIP_LOW, false}, {DPCHIP_PIN_MODE, &mode, DPCHIP_LOW, false}, {DPCHIP_PIN_DIVIDER, &divider, DPCHIP_LOW},
               {DPCHIP_PIN_XTEST0, &xtest0, DPCHIP_HIGH, false}, {DPCHIP_PIN_XTEST1, &xtest1, DPCHIP_HIGH, false}, {DPCHIP_PIN_CLK, &clk, DPCHIP_LOW},
               {DPCHIP_PIN_RESET, &reset, DPCHIP_LOW, false}, {DPCHIP_PIN_XCTS, &xcts, DPCHIP_LOW, false}, {DPCHIP_PIN_RXD, &rxd, DPCHIP_HIGH},
               {DPCHIP_PIN_XCS_AB11, &xcs_ab11, DPCHIP_HIGH, false}, {DPCHIP_PIN_XWR_E_CLOCK_AB11, &xwr_e_clock_ab11, DPCHIP_HIGH},
               {DPCHIP_PIN_XRD_R_W, &xrd_r_w, DPCHIP_HIGH, false}, {DPCHIP_PIN_ALE_AS_AB11, &ale_as_ab11, DPCHIP_LOW}};
    for (std::size_t i = 0; i < kAb.size(); ++i) inputs_.push_back({kAb[i], &ab[i], DPCHIP_LOW});
    outputs_ = {{DPCHIP_PIN_XREADY_XDTACK, &xready_xdtack}, {DPCHIP_PIN_X_INT, &x_int}, {DPCHIP_PIN_XDATAEXCH_SYNC, &xdataexch_sync},
                {DPCHIP_PIN_CLKOUT, &clkout}, {DPCHIP_PIN_TXD, &txd}, {DPCHIP_PIN_RTS, &rts}};
    for (std::size_t i = 0; i < kDb.size(); ++i) data_.push_back({kDb[i], &db[i], DPCHIP_Z, DPCHIP_Z});
}

void Package::before_end_of_elaboration() {
    dpchip_pins_watch(part_.get(), DPCHIP_PIN_CLKOUT, clkout.bind_count() != 0 ? 1 : 0);
    const auto tie = [this](auto& port, int level) {
        if (port.bind_count() != 0) return;
        auto signal = std::make_unique<sc_core::sc_signal<sc_logic>>(sc_core::sc_gen_unique_name("tied"), to_logic(level));
        port.bind(*signal);
        ties_.push_back(std::move(signal));
    };
    for (const Input& input : inputs_) tie(*input.port, input.level);
    for (const Output& output : outputs_) tie(*output.port, DPCHIP_Z);
    for (In& pin : vss) tie(pin, DPCHIP_LOW);
    for (In& pin : vdd) tie(pin, DPCHIP_HIGH);
    for (const Data& data : data_) {
        if (data.port->bind_count() != 0) continue;
        auto signal = std::make_unique<sc_core::sc_signal_resolved>(sc_core::sc_gen_unique_name("tied"));
        data.port->bind(*signal);
        ties_.push_back(std::move(signal));
    }
}

void Package::start_of_simulation() {
    const auto check = [this](const sc_core::sc_vector<In>& pins, int level) {
        for (const In& pin : pins)
            if (from_logic(pin.read()) != level) report::warning(report::kPackage, *this, std::string{pin.basename()} + " is not at its level");
    };
    check(vss, DPCHIP_LOW);
    check(vdd, DPCHIP_HIGH);
}

// ---- time --------------------------------------------------------------------------------------------------------

/// Everything the part does is done here, by one process: outputs have one writer.
void Package::step() {
    if (stopped_) return;
    check(dpchip_pins_advance(part_.get(), to_ticks(sc_core::sc_time_stamp())));
    take_inputs();
    show_outputs();
    plan();
}

/// The code of a function that moves the part: with option "fatal" a timing violation ends it.
void Package::check(int code) {
    if (code >= 0 || stopped_) return;
    stopped_ = true;
    report::error(report::kPackage, *this, dpchip_last_error());
}

void Package::plan() {
    wake_.cancel();
    const Ticks next = dpchip_pins_next(part_.get());
    if (next == kNever || stopped_) return;
    const sc_core::sc_time at = to_sc_time(next);
    const sc_core::sc_time& now = sc_core::sc_time_stamp();
    wake_.notify(at > now ? at - now : sc_core::SC_ZERO_TIME);
}

// ---- pins --------------------------------------------------------------------------------------------------------

/// Inputs that change together change at one tick: the model's checks count time, not the order of calls.
void Package::take_inputs() {
    const auto tell = [this](int pin, int& known, int level) {
        if (level == known) return;
        known = level;
        check(dpchip_pins_set_pin(part_.get(), pin, level));
    };
    for (Input& input : inputs_) {
        const sc_logic& value = input.port->read();
        input.driven = input.driven || value != sc_dt::SC_LOGIC_X;
        if (input.driven) tell(input.pin, input.level, from_logic(value));
    }
    for (Data& data : data_) tell(data.pin, data.level, from_board(data.port->read(), data));
}

/// What the board drives on a DB signal that shows what board and part drive together.
int Package::from_board(const sc_logic& resolved, const Data& data) {
    if (data.driven == DPCHIP_Z) return from_logic(resolved);
    if (resolved == sc_dt::SC_LOGIC_X) return data.driven == DPCHIP_HIGH ? DPCHIP_LOW : DPCHIP_HIGH;
    return data.level == data.driven ? data.level : int{DPCHIP_Z};  // the same level: who drove it before still does
}

void Package::show_outputs() {
    if (!shown_) {
        shown_ = true;
        for (const Output& output : outputs_) output.port->write(to_logic(dpchip_pins_get_pin(part_.get(), output.pin)));
        for (const Data& data : data_) data.port->write(sc_dt::SC_LOGIC_Z);
    }
    Ticks ticks = 0;
    for (int pin = 0, level = 0; dpchip_pins_next_edge(part_.get(), &ticks, &pin, &level) == 1;) show(pin, level);
    std::array<char, 256> text{};
    while (dpchip_pins_finding(part_.get(), text.data(), text.size()) == 1) report::warning(report::kFinding, *this, text.data());
}

void Package::show(int pin, int level) {
    for (const Output& output : outputs_)
        if (output.pin == pin) return output.port->write(to_logic(level));
    for (Data& data : data_) {
        if (data.pin != pin) continue;
        data.driven = level;
        data.port->write(to_logic(level));
    }
}

}  // namespace dpchip::tlm
