// SPDX-License-Identifier: Apache-2.0
// A test bench around one chip: a processor with a minimal firmware on one side, a bus with masters on the other.
//
// Preconditions P0, P1, P2 and the rules for running checks are those of the engineering reference (8.1, 8.2). The
// bench speaks to the chip in whole telegrams, character by character, or bit by bit through a UART; every check runs
// all three ways. Bits begin on the sampling grid, so that times are the same.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <dpchip/chip/chip.hpp>
#include <dpchip/fdl/baud.hpp>
#include <dpchip/pins/uart.hpp>
#include <dpchip/regmap/address.hpp>

namespace dpchip::bench {

using core::Ticks;
using fdl::BaudCode;
using regmap::Variant;
using Octets = std::vector<std::uint8_t>;
namespace control = regmap::control;
namespace org = regmap::org;
namespace irq = regmap::interrupt;

/// "10 02 08" -> {0x10, 0x02, 0x08}. Throws std::invalid_argument on anything else.
Octets hex(std::string_view text);
/// {0x10, 0x02, 0x08} -> "10 02 08".
std::string text(std::span<const std::uint8_t> octets);
/// What ask() returns when nothing was answered.
inline constexpr std::string_view kSilence = "silence";

/// How telegrams reach the chip.
enum class Path : std::uint8_t { telegrams, characters, bits };
constexpr std::string_view name(Path path) {
    return path == Path::telegrams ? "telegrams" : path == Path::characters ? "characters" : "bits";
}

/// What a bench is built for: the figures of precondition P0, each of which a check may change.
struct Recipe {
    Variant variant = Variant::vpc3c;
    Path path = Path::telegrams;
    chip::BusMode bus_mode = chip::BusMode::intel;
    BaudCode baud = BaudCode::mbit_1_5;
    std::uint8_t ts = 8;
    std::uint16_t ident = 0x4711;
    std::uint8_t dout = 2, din = 2;
    std::uint8_t aux1 = 20, aux2 = 0, aux_sel = 0;
    bool ssa = false;              ///< with an SSA buffer, R_Real_No_Add_Change = 00H
    std::uint16_t mode0 = 0x01C0;  ///< DP_Mode, Sync, Freeze
    std::optional<std::uint8_t> mode2{}, mode3{}, baud_control{};
    std::uint8_t min_tsdr = 11;
    std::uint16_t user_wd = 0x7FFF;
    Octets read_cfg{0x11, 0x21};
    regmap::Options options = quick_search();

    /// Default options with a baud rate search of 124 ms per round instead of 1.77 s.
    static regmap::Options quick_search();
};

/// How far a bench brings the chip before the check begins.
enum class Stage : std::uint8_t {
    reset,       ///< hardware reset state
    configured,  ///< registers and cells written, still Offline
    searching,   ///< Start given, no baud rate yet
    p0,
    p1,
    p2,  ///< the preconditions of 8.1
};

/// What an octet of a telegram suffers on its way.
struct Fault {
    std::size_t octet{};
    std::uint8_t faults{};  ///< mask of fdl::CharacterFault
};
struct Gap {
    std::size_t after{};  ///< index of the octet in front of the gap
    std::int64_t bits{};  ///< idle bit times
};
struct Stimulus {
    Octets octets;
    std::vector<Fault> faults{};
    std::vector<Gap> gaps{};
};

struct Answer {
    Octets octets;
    Ticks start{}, end{};
};

struct Outputs {
    std::uint8_t command{};  ///< what Next_Dout_Buffer_Cmd returned
    Octets octets;           ///< the U buffer, R_Len_Dout_Buf octets
};

class Bench {
public:
    using ChipUnderTest = chip::Chip<core::RingTrace>;

    Bench(const Recipe& recipe, Stage stage);

    // ---- the bus ------------------------------------------------------------------------------------------------
    /// Sends a request as a master does: the FCB toggles where it has to, the FCS follows (8.2). Returns the answer.
    std::string ask(std::string_view request) { return ask(hex(request)); }
    std::string ask(const Octets& request);
    /// Sends exactly these octets.
    std::string ask_verbatim(std::string_view request);
    /// Sends the previous request once more, octet for octet: a retry.
    std::string ask_again();
    /// Sends without waiting for an answer; ends at the end of the last stop bit.
    void tell(const Stimulus& stimulus);
    void tell(std::string_view octets) { tell(Stimulus{hex(octets), {}, {}}); }
    /// What the chip answers to the last telegram, if it begins within `bits` bit times.
    std::optional<Answer> listen(std::int64_t bits = 320);
    std::string listen_text();
    /// Slave_Diag by master 2: the answer.
    std::string diag() { return ask("68 05 05 68 88 82 5D 3C 3E E1 16"); }
    /// SD2 to the chip: SA without extension bit, SAPs where given, FCS and lengths computed. SD1 without a data unit.
    Octets request(std::uint8_t sa, std::uint8_t fc, std::optional<std::uint8_t> dsap, const Octets& data) const;
    /// Status requests at the rate of the recipe until the chip has found it.
    void find_baud();

    // ---- time ---------------------------------------------------------------------------------------------------
    /// Moves time; an answer that nobody asked for is a failure.
    void run_to(Ticks to);
    void run(Ticks duration) { run_to(now() + duration); }
    Ticks now() const { return chip_.now(); }
    Ticks bit() const { return fdl::baud(recipe_.baud).bit; }
    Ticks bits(std::int64_t n) const { return bit() * n; }
    Ticks request_end() const { return request_end_; }
    const Answer& last_answer() const { return last_answer_; }

    // ---- the processor ------------------------------------------------------------------------------------------
    /// Intel addresses; the bench inverts address bit 0 where Motorola mode wants it.
    std::uint8_t read(std::uint16_t address) { return chip_.read(cpu(address)); }
    void write(std::uint16_t address, std::uint8_t value) { chip_.write(cpu(address), value); }
    std::uint8_t peek(std::uint16_t address) const { return chip_.peek(cpu(address)); }
    std::uint16_t peek_word(std::uint16_t low) const;
    void write_word(std::uint16_t low, std::uint16_t value);
    Octets ram(std::uint16_t address, std::size_t size) const;
    /// Address of the buffer whose segment stands in `pointer_cell`.
    std::uint16_t buffer(std::uint16_t pointer_cell) const {
        return static_cast<std::uint16_t>(peek(pointer_cell) << 3);
    }
    /// Interrupt Request Register without User_Timer_Clock, which comes by itself (8.2).
    std::uint16_t irr() const {
        return static_cast<std::uint16_t>(peek_word(control::int_req_reg_low) & ~irq::user_timer_clock);
    }
    void acknowledge(std::uint16_t bits = 0xFFFF) { write_word(control::int_ack_reg_low, bits); }
    /// Status Register: DP_State (00 WAIT-PRM, 01 WAIT-CFG, 10 DATA-EXCH) and WD_State (00, 01, 10).
    unsigned dp_state() const { return (peek(control::status_reg_low) >> 4) & 3u; }
    unsigned wd_state() const { return (peek(control::status_reg_low) >> 6) & 3u; }
    bool diag_flag() const { return (peek(control::status_reg_low) & 4u) != 0; }

    // ---- the firmware -------------------------------------------------------------------------------------------
    /// Writes inputs into the U buffer and gives them to the chip; returns what 09H returned.
    std::uint8_t give_inputs(std::string_view octets);
    /// Next_Dout_Buffer_Cmd, then the U buffer.
    Outputs take_outputs();
    /// Fills the user's diagnosis buffer (octet 0: control bits, ext_diag from octet 6 on) and reads 0DH.
    std::uint8_t give_diag(std::uint8_t control_bits, std::string_view ext_diag = {});
    void start();
    void go_offline();
    ChipUnderTest& chip() { return chip_; }
    /// Path::bits: what stands between the chip and the line.
    pins::Uart<core::RingTrace>& uart() { return uart_; }
    /// Called after every advance and every character: for tests that meddle with the chip at odd moments.
    void set_meddler(std::function<void(ChipUnderTest&)> meddler) { meddler_ = std::move(meddler); }
    /// Longest single advance; kNever: from event to event.
    void set_chunk(Ticks chunk) { chunk_ = chunk; }
    const ChipUnderTest& chip() const { return chip_; }
    const Recipe& recipe() const { return recipe_; }
    const regmap::Traits& traits() const { return regmap::traits(recipe_.variant); }

private:
    std::uint16_t cpu(std::uint16_t address) const;
    void configure();
    void configure_registers();
    void configure_buffers();
    Octets with_fcb(Octets request) const;
    void remember(const Octets& request);
    std::string send(const Octets& octets);
    void tell_characters(Ticks start, const Stimulus& stimulus);
    void tell_bits(Ticks start, const Stimulus& stimulus);
    void send_bits(const fdl::Character& c);
    bool begins_to_send(fdl::Transmission& sent);
    void collect_edges();
    Octets octets_on_txd(Ticks start) const;
    Ticks next() const { return by_bits() ? uart_.next(chip_) : chip_.next(); }
    bool by_bits() const { return recipe_.path == Path::bits; }
    void move_chip(Ticks to) { by_bits() ? uart_.advance(chip_, to) : chip_.advance(to); }
    bool step(Ticks to, Answer& answer);
    void move(Ticks to);

    Recipe recipe_;
    ChipUnderTest chip_;
    pins::Uart<core::RingTrace> uart_{};       ///< Path::bits: moves the chip
    std::vector<pins::PinEdge> txd_{};         ///< edges since the chip began to send
    Ticks free_{};  ///< end of the last activity on the line
    Ticks request_end_{};
    Answer last_answer_{};
    Octets last_request_{};
    std::optional<std::uint8_t> last_sa_{};
    bool last_fcb_ = false;
    std::function<void(ChipUnderTest&)> meddler_{};
    Ticks chunk_ = core::kNever;
};

/// DP_State and WD_State as the Status Register codes them.
inline constexpr unsigned kWaitPrm = 0, kWaitCfg = 1, kDataExch = 2;
inline constexpr unsigned kBaudSearch = 0, kBaudControl = 1, kDpControl = 2;

/// Telegrams that many checks share (reference 8.5 to 8.7).
inline constexpr std::string_view kFdlStatus = "10 08 02 49 53 16", kFdlStatusOk = "10 02 08 00 0A 16";
inline constexpr std::string_view kRs = "10 02 08 03 0D 16", kRr = "10 02 08 02 0C 16", kSc = "E5";
inline constexpr std::string_view kPrm = "68 0C 0C 68 88 82 5D 3D 3E 88 02 05 0B 47 11 00 D4 16";
inline constexpr std::string_view kPrm10 = "68 0F 0F 68 88 82 5D 3D 3E 88 02 05 0B 47 11 01 80 00 00 55 16";
inline constexpr std::string_view kCfg = "68 07 07 68 88 82 7D 3E 3E 11 21 35 16";
inline constexpr std::string_view kDx1234 = "68 05 05 68 08 02 7D 12 34 CD 16",
                                  kDx5678 = "68 05 05 68 08 02 5D 56 78 35 16";
inline constexpr std::string_view kInputs = "68 05 05 68 02 08 08 AB CD 8A 16";
inline constexpr std::string_view kDiagWaitPrm = "68 0B 0B 68 82 88 08 3E 3C 02 05 00 FF 47 11 EA 16";
inline constexpr std::string_view kDiagPrmFault = "68 0B 0B 68 82 88 08 3E 3C 42 05 00 FF 47 11 2A 16";
inline constexpr std::string_view kDiagCfgFault = "68 0B 0B 68 82 88 08 3E 3C 06 05 00 FF 47 11 EE 16";
inline constexpr std::string_view kDiagWaitCfg = "68 0B 0B 68 82 88 08 3E 3C 02 0C 00 02 47 11 F4 16";
inline constexpr std::string_view kDiagDataExch = "68 0B 0B 68 82 88 08 3E 3C 00 0C 00 02 47 11 F2 16";

}  // namespace dpchip::bench
