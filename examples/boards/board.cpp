// SPDX-License-Identifier: Apache-2.0
// Board: power-up, search of the chip's addresses, firmware, master, report.
#include "board.hpp"

#include <algorithm>
#include <array>
#include <iomanip>
#include <ostream>
#include <sstream>

#include <dpchip/driver/vpc3.hpp>
#include <dpchip/master/master.hpp>
#include <dpchip/trace/pin_finding_text.hpp>

namespace boards {

const std::vector<pins::Connection> kEveryBoard{
    on_gnd(PinId::vss_6), on_gnd(PinId::vss_17), on_gnd(PinId::vss_28), on_gnd(PinId::vss_38), on_vdd(PinId::vdd_18), on_vdd(PinId::vdd_39),
    from("48 MHz", PinId::clk), pull_up("3.3 kOhm", PinId::xtest0), pull_up("3.3 kOhm", PinId::xtest1),
    from("RxD", PinId::rxd), to("TxD", PinId::txd), pull_up("3.3 kOhm", PinId::txd), to("RTS", PinId::rts), pull_down("1 kOhm", PinId::xcts),
    to("LED", PinId::xdataexch_sync),
};

std::vector<pins::Connection> data_bus(const std::vector<std::string_view>& names) {
    std::vector<pins::Connection> table;
    for (std::size_t i = 0; i < names.size(); ++i) table.push_back(both_ways(names[i], pins::kDataBus[i]));
    return table;
}

std::vector<pins::Connection> address_bus(unsigned first_pin, const std::vector<std::string_view>& names) {
    std::vector<pins::Connection> table;
    for (std::size_t i = 0; i < names.size(); ++i) table.push_back(from(names[i], pins::kAddressBus[first_pin + i]));
    return table;
}

std::vector<pins::Connection> join(std::initializer_list<std::vector<pins::Connection>> tables) {
    std::vector<pins::Connection> all;
    for (const auto& table : tables) all.insert(all.end(), table.begin(), table.end());
    return all;
}

namespace {

constexpr std::uint8_t kStation = 5;
constexpr std::uint16_t kIdent = 0x4711;
constexpr std::array<std::uint8_t, 2> kCfg{0x11, 0x21};  ///< 2 octets of inputs, 2 of outputs
constexpr std::array<std::uint8_t, 2> kOutputs{0x5A, 0xC3};
constexpr std::uint64_t kStorm = 16;

/// The chip in the processor's address space: a driver::BusPort.
struct Port {
    Processor* processor;
    std::uint32_t base, stride;

    std::uint8_t read(std::uint16_t address) const { return processor->read(base + address * stride); }
    void write(std::uint16_t address, std::uint8_t value) const { processor->write(base + address * stride, value); }
    void read_block(std::uint16_t address, std::span<std::uint8_t> out) const {
        for (std::uint8_t& octet : out) octet = read(address++);
    }
    void write_block(std::uint16_t address, std::span<const std::uint8_t> in) const {
        for (const std::uint8_t octet : in) write(address++, octet);
    }
};

/// The same on every board: outputs come back as inputs.
struct Firmware : driver::Events {
    explicit Firmware(const Port& port) : driver{port, *this} {}
    void dx_out() {
        std::array<std::uint8_t, 2> io{};
        if (driver.fetch_outputs(io) != driver::Outputs::unchanged) driver.write_inputs(io);
    }
    driver::Vpc3<Port, Firmware> driver;
};

class Board {
public:
    explicit Board(const Plan& plan)
        : plan_{plan}, wiring_{std::span{plan.wiring}}, package_{plan.variant, plan.supply}, circuit_{package_, wiring_.add(kEveryBoard)},
          reset_{wiring_, "RESET"}, interrupt_{wiring_, plan.interrupt_line} {}

    Report run() {
        const bool with_4k = plan_.ram == driver::RamSize::bytes_4096;
        for (const pins::WiringFault& f : wiring_.check(with_4k)) report_.wiring.emplace_back(std::string_view{text(f, plan_.variant)});
        wiring_.tie(package_);
        report_.period = processor_period();
        report_.clocked = report_.period > Ticks{};
        if (report_.clocked) {
            processor_ = plan_.make(circuit_, report_.period);
            power_up();
            sweep();
            start_and_exchange();
            if (plan_.memory) try_memory(*plan_.memory);
        }
        collect();
        return report_;
    }

private:
    /// CLKOUT2/4 as DIVIDER has it, or the processor's own crystal; 0 when no clock reaches it.
    Ticks processor_period() const {
        if (plan_.crystal_hz != 0) return Ticks{core::kTicksPerSecond / plan_.crystal_hz};
        if (!wiring_.line(plan_.clock_line).connected()) return {};
        return core::kClk * (package_.pin(PinId::divider) == PinLevel::high ? 2 : 4);
    }
    void power_up() {
        circuit_.plan(circuit_.now(), reset_);
        processor_->power_up();
        circuit_.plan(circuit_.now() + 1_ms, reset_, 0);
        circuit_.run(circuit_.now() + 1_ms + 10_us);
    }
    /// Reads everywhere, and notes where the chip feels addressed. 80H of a page is no register.
    void sweep() {
        std::vector<Range>& found = report_.selected;
        for (std::uint64_t a = plan_.swept.first; a < plan_.swept.last; a += plan_.step) {
            const auto address = static_cast<std::uint32_t>(a);
            processor_->read(address + 0x80 * plan_.stride);
            if (!processor_->selected()) continue;
            if (!found.empty() && found.back().last + 1 == address) found.back().last += plan_.step;
            else found.push_back({address, address + plan_.step - 1});
        }
    }
    /// Beside a chip that works.
    void try_memory(Range range) {
        constexpr std::uint32_t kStep = 0x3FB;
        const auto pattern = [](std::uint32_t address) { return static_cast<std::uint8_t>(address ^ (address >> 7) ^ 0xA5); };
        for (std::uint32_t a = range.first; a <= range.last; a += kStep) processor_->write(a, pattern(a));
        for (std::uint32_t a = range.first; a <= range.last; a += kStep) {
            const bool right = processor_->read(a) == pattern(a) && !processor_->selected();
            report_.memory_works = report_.memory_works && right;
        }
    }
    driver::Config config() const {
        driver::Config c;
        c.variant = plan_.variant;
        c.ram = plan_.ram;
        c.bus_mode = plan_.bus_mode;
        c.int_polarity = plan_.int_polarity;
        c.test_ram = plan_.test_ram;
        c.address = kStation;
        c.ident = kIdent;
        c.cfg = kCfg;
        return c;
    }
    void start_and_exchange() {
        Firmware firmware{{processor_.get(), plan_.base, plan_.stride}};
        report_.config = firmware.driver.configure(config());
        if (report_.config != driver::ConfigError::none || !firmware.driver.start()) return;
        report_.up_after = circuit_.now();

        master::SlaveConfig slave;
        slave.address = kStation;
        slave.ident = kIdent;
        slave.cfg.assign(kCfg.begin(), kCfg.end());
        slave.input_octets = slave.output_octets = kOutputs.size();
        if (!master_.add(slave)) return;
        circuit_.line().attach(adapter_);
        report_.exchanging = serve_until(firmware, [&] { return master_.all_exchanging(); }, 100_ms);
        report_.exchange_after = circuit_.now();
        if (!report_.exchanging) return;
        std::ranges::copy(kOutputs, master_.slave(0).outputs().begin());
        report_.echoed = serve_until(firmware, [&] { return std::ranges::equal(master_.slave(0).inputs(), kOutputs); }, 20_ms);
    }
    bool interrupted() const {
        return interrupt_.lines()[0].level(package_) == plan_.interrupt_level;
    }
    /// The main program waits, interrupts are served.
    template <class Done>
    bool serve_until(Firmware& firmware, Done&& done, Ticks limit) {
        const Ticks end = circuit_.now() + limit;
        while (!done()) {
            if (circuit_.now() >= end || report_.spurious_interrupts > kStorm) return false;
            if (!interrupted()) {
                processor_->idle(std::min(end, std::max(circuit_.next(), circuit_.now() + Ticks{1})));
                continue;
            }
            if (firmware.driver.on_interrupt() == 0) ++report_.spurious_interrupts;
            processor_->idle(circuit_.now() + 500_ns);  // the routine returns
        }
        return true;
    }
    void collect() {
        Report& r = report_;
        r.mode = package_.mode();
        for (const regmap::TimingParameter& p : regmap::kBusTiming)
            if (package_.violations(p.number) != 0) r.violated.push_back(p.number);
        for (auto& queue = package_.findings(); !queue.empty();) {
            const core::Finding f = queue.pop();
            std::string words = trace::pin_finding_text(f.rule, f.detail);
            if (std::ranges::find(r.findings, words) == r.findings.end()) r.findings.push_back(std::move(words));
        }
        for (const Slack& slack : circuit_.slack().all())
            if (slack.number != 0 && slack.spare < Ticks{}) r.without_slack.push_back(slack.number);
        r.shortest_cycle = circuit_.slack().shortest_cycle();
        r.tightest = circuit_.slack().tightest();
        if (!processor_) return;
        r.accesses = processor_->accesses();
        r.late_reads = processor_->late_reads();
        r.never_ready = processor_->never_ready();
    }

    const Plan& plan_;
    pins::Wiring wiring_;
    pins::Package<> package_;
    master::Master master_{{.min_cycle = 500_us}};
    pins::TelegramAdapter<master::Master> adapter_{master_, fdl::BaudCode::mbit_12};
    Circuit circuit_;
    Signal reset_, interrupt_;
    std::unique_ptr<Processor> processor_;
    Report report_;
};

/// Nanoseconds with one digit.
struct Ns {
    Ticks t;
    friend std::ostream& operator<<(std::ostream& out, Ns ns) {
        const std::int64_t tenths = std::abs(ns.t.n) * 10 / core::kTicksPerNs;
        return out << (ns.t.n < 0 ? "-" : "") << tenths / 10 << '.' << tenths % 10 << " ns";
    }
};

std::string hex(std::uint32_t address) {
    std::string digits;
    for (int shift = 20; shift >= 0; shift -= 4)
        if (const unsigned digit = (address >> shift) & 15u; digit != 0 || !digits.empty() || shift <= 12) digits += "0123456789ABCDEF"[digit];
    return digits + "H";
}

/// "<- A8": a line that drives the pin; "-> INT0": one that the chip drives.
std::string at_other_end(const pins::Connection& c) {
    std::string line = (c.inverted ? "not " : "") + std::string{c.line};
    switch (c.end) {
    case pins::FarEnd::drives: return "<- " + line;
    case pins::FarEnd::listens: return "-> " + line;
    case pins::FarEnd::both: return "<> " + line;
    case pins::FarEnd::vdd:
    case pins::FarEnd::gnd: return line;
    case pins::FarEnd::pull_up: return line + " to VDD";
    case pins::FarEnd::pull_down: return line + " to GND";
    }
    return line;
}

}  // namespace

bool Report::good(const Plan& plan) const {
    return wiring.empty() && findings.empty() && violated.empty() && clocked && selected == std::vector{plan.selected} &&
           config == driver::ConfigError::none && exchanging && echoed && memory_works && late_reads == 0 && never_ready == 0 && spurious_interrupts == 0;
}

Report run(const Plan& plan) { return Board{plan}.run(); }

void print(std::ostream& out, const Plan& plan, const Report& r) {
    const std::int64_t khz = r.clocked ? core::kTicksPerSecond / r.period.n / 1000 : 0;
    out << plan.name << ": " << plan.processor << ", " << plan.figure << '\n'
        << "  clock      " << khz / 1000 << '.' << std::setw(3) << std::setfill('0') << khz % 1000 << " MHz, "
        << (plan.crystal_hz != 0 ? "crystal" : "from CLKOUT2/4") << "; " << regmap::name(r.mode) << " mode, "
        << regmap::name(plan.supply) << '\n'
        << "  chip       at " << hex(plan.base) << (plan.stride == 2 ? ", every second address" : "") << "; selected";
    for (const Range& s : r.selected) out << ' ' << hex(s.first) << ".." << hex(s.last);
    out << (r.selected.empty() ? " nowhere\n" : "\n")
        << "  accesses   " << r.accesses << ", shortest cycle " << Ns{r.shortest_cycle == core::kNever ? Ticks{} : r.shortest_cycle} << '\n';
    if (r.tightest)
        out << "  tightest   parameter " << r.tightest->number << ", " << regmap::timing(r.tightest->number).name << ": " << Ns{r.tightest->found} << ", "
            << Ns{r.tightest->spare} << " to spare\n";
    out << "  violations " << r.violated.size();
    for (const unsigned number : r.violated) out << (number == r.violated.front() ? ": " : ", ") << number;
    out << '\n';
    if (r.config != driver::ConfigError::none) out << "  the firmware says: " << name(r.config) << '\n';
    if (r.exchanging)
        out << "  DATA-EXCH  " << core::to_ns(r.exchange_after - r.up_after) / 1000 << " us after start; outputs " << (r.echoed ? "came back" : "DID NOT COME BACK") << '\n';
    else out << "  NO DATA-EXCH\n";
    if (!r.memory_works) out << "  THE BOARD'S MEMORY DOES NOT WORK\n";
    if (r.late_reads != 0) out << "  reads without data in time: " << r.late_reads << '\n';
    if (r.never_ready != 0) out << "  cycles that never became ready: " << r.never_ready << '\n';
    if (r.spurious_interrupts != 0) out << "  interrupts without an event: " << r.spurious_interrupts << '\n';
    for (const std::string& words : r.wiring) out << "  wiring: " << words << '\n';
    for (const std::string& words : r.findings) out << "  finding: " << words << '\n';
}

void print_wiring(std::ostream& out, const Plan& plan) {
    pins::Wiring wiring{std::span{plan.wiring}};
    wiring.add(kEveryBoard);
    const auto row = [&](unsigned number) {
        const pins::PinInfo& pin = pins::info(static_cast<PinId>(number));
        std::string words;
        for (const pins::Connection& c : wiring.connections())
            if (c.pin == pin.id) words += (words.empty() ? "" : ", ") + at_other_end(c);
        std::ostringstream text;
        text << std::setw(2) << number << ' ' << std::left << std::setw(17) << (plan.variant == pins::Variant::apc3 ? pin.apc3_name : pin.name) << std::setw(26)
             << (words.empty() ? "open" : words);
        return text.str();
    };
    for (unsigned number = 1; number <= pins::kPins / 2; ++number) {
        std::string line = row(number) + row(number + pins::kPins / 2);
        out << line.erase(line.find_last_not_of(' ') + 1) << '\n';
    }
}

std::vector<Plan> all_boards() {
    return {board_80c32_2k(), board_80c32_4k(), board_80c32_memory(), board_80c165(), board_80286(), board_hc11(), board_hc16()};
}

}  // namespace boards
