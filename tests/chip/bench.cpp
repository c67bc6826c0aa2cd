// SPDX-License-Identifier: Apache-2.0
// The test bench: see bench.hpp.
#include "bench.hpp"

#include <algorithm>
#include <array>
#include <stdexcept>

#include <gtest/gtest.h>

#include <dpchip/core/bits.hpp>
#include <dpchip/fdl/telegram.hpp>

namespace dpchip::bench {

using namespace core::literals;

namespace {

// Segments of 8 octets; 32 octets per buffer, 64 for diagnosis. Ends at 248H: fits the smallest RAM of the family.
constexpr std::array<std::uint8_t, 3> kDout{0x08, 0x0C, 0x10}, kDin{0x14, 0x18, 0x1C};
constexpr std::array<std::uint8_t, 2> kDiag{0x20, 0x28};
constexpr std::uint8_t kCfgBuf = 0x30, kReadCfgBuf = 0x34, kPrmBuf = 0x38, kAux1 = 0x3C, kAux2 = 0x40, kSsa = 0x44,
                       kSapList = 0x48;

int nibble(char c) {
    if (c >= '0' && c <= '9') return c - '0';
    if (c >= 'A' && c <= 'F') return c - 'A' + 10;
    if (c >= 'a' && c <= 'f') return c - 'a' + 10;
    throw std::invalid_argument{"not a hexadecimal digit"};
}

std::size_t fc_index(const Octets& telegram) { return telegram.at(0) == fdl::kSd2 ? 6 : 3; }

/// Functions the frame count bit applies to (reference 2.5).
bool counts_frames(std::uint8_t fc) {
    const unsigned function = fc & 0x0Fu;
    return (fc & 0xC0u) == 0x40u &&
           (function == 3 || function == 5 || function == 7 || function == 12 || function == 13);
}

}  // namespace

Octets hex(std::string_view text) {
    Octets octets;
    for (std::size_t i = 0; i < text.size();) {
        if (text[i] == ' ') {
            ++i;
            continue;
        }
        if (i + 1 == text.size()) throw std::invalid_argument{"half an octet"};
        octets.push_back(static_cast<std::uint8_t>(nibble(text[i]) << 4 | nibble(text[i + 1])));
        i += 2;
    }
    return octets;
}

std::string text(std::span<const std::uint8_t> octets) {
    static constexpr char kDigits[] = "0123456789ABCDEF";
    std::string out;
    for (const std::uint8_t o : octets) {
        if (!out.empty()) out += ' ';
        out += kDigits[o >> 4];
        out += kDigits[o & 15];
    }
    return out;
}

regmap::Options Recipe::quick_search() {
    regmap::Options options;
    options.baud_probe_ms = {1, 1, 1, 1, 2, 4, 8, 16, 31, 59};
    return options;
}

Bench::Bench(const Recipe& recipe, Stage stage)
    : recipe_{recipe}, chip_{recipe.variant, recipe.options, recipe.bus_mode} {
    if (stage >= Stage::configured) configure();
    if (stage >= Stage::searching) start();
    if (stage >= Stage::p0) {
        find_baud();
        acknowledge();
    }
    if (stage >= Stage::p1) {
        EXPECT_EQ(ask(request(2, 0x5D, 0x3D,
                              {0x88, 0x02, 0x05, 0x0B, core::high(recipe.ident), core::low(recipe.ident), 0x00})),
                  kSc);
        EXPECT_EQ(dp_state(), kWaitCfg);
    }
    if (stage >= Stage::p2) {
        EXPECT_EQ(ask(kCfg), kSc);
        EXPECT_EQ(read(control::user_cfg_data_okay), 0);
        give_inputs("AB CD");
        EXPECT_EQ(dp_state(), kDataExch);
        run(2_clk);  // an interrupt of this very CLK period would outlive its acknowledgement
        acknowledge();
    }
}

// ---- the processor ------------------------------------------------------------------------------------------------

std::uint16_t Bench::cpu(std::uint16_t address) const {
    const bool word_register =
        address < 8 || address == org::r_user_wd_value_low || address == org::r_user_wd_value_high;
    return recipe_.bus_mode == chip::BusMode::motorola && word_register ? address ^ 1u : address;
}

std::uint16_t Bench::peek_word(std::uint16_t low) const {
    return core::word(peek(static_cast<std::uint16_t>(low + 1)), peek(low));
}

void Bench::write_word(std::uint16_t low, std::uint16_t value) {
    write(low, core::low(value));
    write(static_cast<std::uint16_t>(low + 1), core::high(value));
}

Octets Bench::ram(std::uint16_t address, std::size_t size) const {
    Octets octets(size);
    for (std::size_t i = 0; i < size; ++i) octets[i] = chip_.peek(static_cast<std::uint16_t>(address + i));
    return octets;
}

void Bench::configure() {
    for (unsigned a = org::first; a < traits().ram_bytes; ++a) chip_.write(static_cast<std::uint16_t>(a), 0x00);
    configure_registers();
    configure_buffers();
}

void Bench::configure_registers() {
    write_word(control::int_req_reg_low, 0x0000);
    acknowledge();
    write(control::mode_reg1_r, 0xFF);
    write_word(control::mode_reg0_low, recipe_.mode0);
    if (recipe_.mode2) write(control::mode_reg2, *recipe_.mode2);
    if (recipe_.mode3) write(control::mode_reg3, *recipe_.mode3);
    if (recipe_.baud_control) write(control::wd_baud_control_val, *recipe_.baud_control);
    write(control::min_tsdr_val, recipe_.min_tsdr);
}

void Bench::configure_buffers() {
    write(org::r_ts_adr, recipe_.ts);
    write_word(org::r_ident_low, recipe_.ident);
    write_word(org::r_user_wd_value_low, recipe_.user_wd);
    write(org::r_real_no_add_change, recipe_.ssa ? 0x00 : 0xFF);
    write(org::sap_list_ptr, kSapList);
    chip_.write(kSapList << 3, 0xFF);
    write(org::r_len_dout_buf, recipe_.dout);
    write(org::r_len_din_buf, recipe_.din);
    for (std::uint16_t i = 0; i < 3; ++i) {
        write(static_cast<std::uint16_t>(org::r_dout_buf_ptr1 + i), kDout[i]);
        write(static_cast<std::uint16_t>(org::r_din_buf_ptr1 + i), kDin[i]);
    }
    for (std::uint16_t i = 0; i < 2; ++i) {
        write(static_cast<std::uint16_t>(org::r_len_diag_buf1 + i), 6);
        write(static_cast<std::uint16_t>(org::r_diag_buf_ptr1 + i), kDiag[i]);
    }
    write(org::r_len_cntrl_buf1, recipe_.aux1);
    write(org::r_len_cntrl_buf2, recipe_.aux2);
    write(org::r_aux_buf_sel, recipe_.aux_sel);
    write(org::r_aux_buf_ptr1, kAux1);
    write(org::r_aux_buf_ptr2, recipe_.aux2 != 0 ? kAux2 : std::uint8_t{0});
    write(org::r_ssa_buf_ptr, recipe_.ssa ? kSsa : std::uint8_t{0});
    write(org::r_prm_buf_ptr, kPrmBuf);
    write(org::r_cfg_buf_ptr, kCfgBuf);
    write(org::r_read_cfg_buf_ptr, kReadCfgBuf);
    write(org::r_len_read_cfg_data, static_cast<std::uint8_t>(recipe_.read_cfg.size()));
    chip_.write_block(kReadCfgBuf << 3, recipe_.read_cfg);
}

void Bench::start() {
    write(control::mode_reg1_s, regmap::mode1::start_vpc3);
    run(2_clk);
}

void Bench::go_offline() {
    write(control::mode_reg1_s, regmap::mode1::go_offline);
    run(48_clk);
}

std::uint8_t Bench::give_inputs(std::string_view octets) {
    const unsigned u = (peek(control::din_buffer_sm) >> 4) & 3u;
    chip_.write_block(buffer(static_cast<std::uint16_t>(org::r_din_buf_ptr1 + u - 1)), hex(octets));
    return read(control::new_din_buffer_cmd);
}

Outputs Bench::take_outputs() {
    const std::uint8_t command = read(control::next_dout_buffer_cmd);
    const unsigned u = command & regmap::next_dout::ind_u_buffer;
    EXPECT_NE(u, 0u) << "Next_Dout_Buffer_Cmd names no buffer";
    return {command, ram(buffer(static_cast<std::uint16_t>(org::r_dout_buf_ptr1 + u - 1)), peek(org::r_len_dout_buf))};
}

std::uint8_t Bench::give_diag(std::uint8_t control_bits, std::string_view ext_diag) {
    const Octets ext = hex(ext_diag);
    const std::uint8_t sm = peek(control::diag_buffer_sm);
    const std::uint16_t index = (sm & 3u) == regmap::diag_owner::user ? 0 : 1;
    EXPECT_EQ((sm >> (2 * index)) & 3u, unsigned{regmap::diag_owner::user}) << "no diagnosis buffer is the user's";
    const std::uint16_t at = buffer(static_cast<std::uint16_t>(org::r_diag_buf_ptr1 + index));
    chip_.write(at, control_bits);
    chip_.write_block(static_cast<std::uint16_t>(at + 6), ext);
    write(static_cast<std::uint16_t>(org::r_len_diag_buf1 + index), static_cast<std::uint8_t>(6 + ext.size()));
    const std::uint8_t result = read(control::new_diag_buffer_cmd);
    run(2_clk);
    return result;
}

// ---- time -----------------------------------------------------------------------------------------------------------

/// One way to an event: in chunks where the test wants them.
void Bench::move(Ticks to) {
    while (chunk_ != core::kNever && to - chip_.now() > chunk_) {
        move_chip(chip_.now() + chunk_);
        if (meddler_) meddler_(chip_);
    }
    move_chip(to);
}

/// An answer begins now: the chip gives it away or, bit by bit, its first start bit is on TXD.
bool Bench::begins_to_send(fdl::Transmission& sent) {
    if (!by_bits()) return chip_.take(sent);
    const std::size_t before = txd_.size();
    collect_edges();
    const bool idle = before == 0 || txd_[before - 1].level == pins::PinLevel::z || uart_.state().tx_index == 0;
    if (!idle || txd_.empty() || txd_.size() == before || txd_.back().at != chip_.now() || txd_.back().level != pins::PinLevel::low) return false;
    if (uart_.state().tx_index != 0 || uart_.state().tx_start != chip_.now()) return false;
    txd_.erase(txd_.begin(), txd_.end() - 1);
    const chip::State& s = chip_.state();
    sent.assign(chip_.now(), s.answer_bit, {s.tx.data(), s.tx_count});
    return true;
}

void Bench::collect_edges() {
    while (!uart_.edges().empty()) txd_.push_back(uart_.edges().pop());
    EXPECT_EQ(uart_.edges().overflows(), 0u);
}

/// What the edges on TXD since `start` say, read in the middle of every bit.
Octets Bench::octets_on_txd(Ticks start) const {
    const auto level_at = [&](Ticks at) {
        pins::PinLevel level = pins::PinLevel::z;
        for (const pins::PinEdge& e : txd_)
            if (e.at <= at) level = e.level;
        return level;
    };
    Octets octets;
    for (;; start += bits(fdl::kCharacterBits)) {
        const auto middle = [&](std::int64_t n) { return level_at(start + bits(n) + Ticks{bit().n / 2}); };
        if (middle(0) != pins::PinLevel::low) break;
        unsigned octet = 0;
        for (int n = 0; n < 8; ++n) octet |= middle(1 + n) == pins::PinLevel::high ? 1u << n : 0u;
        octets.push_back(static_cast<std::uint8_t>(octet));
        EXPECT_EQ(middle(9) == pins::PinLevel::high, fdl::even_parity(octets.back()));
        EXPECT_EQ(middle(10), pins::PinLevel::high);
    }
    return octets;
}

/// Advances event by event up to `to`; stops early, true, when the chip begins to send.
bool Bench::step(Ticks to, Answer& answer) {
    fdl::Transmission sent;
    int standstill = 0;
    while (next() <= to) {
        const Ticks before = chip_.now();
        move(std::max(next(), before));
        if (begins_to_send(sent)) {
            EXPECT_EQ(sent.start, chip_.now()) << "an answer begins when it is taken";
            answer = {Octets(sent.bytes().begin(), sent.bytes().end()), sent.start, sent.end()};
            if (meddler_) meddler_(chip_);
            return true;
        }
        if (meddler_) meddler_(chip_);
        standstill = chip_.now() == before ? standstill + 1 : 0;
        if (standstill > 1000) throw std::runtime_error{"the chip's next() stands still"};
    }
    move(to);
    return false;
}

void Bench::run_to(Ticks to) {
    Answer answer;
    while (step(to, answer)) ADD_FAILURE() << "unexpected answer " << text(answer.octets);
}

std::optional<Answer> Bench::listen(std::int64_t bit_times) {
    Answer answer;
    if (!step(request_end_ + bits(bit_times) + 20_us, answer)) return std::nullopt;
    free_ = answer.end;
    run_to(answer.end + 4_clk);
    if (by_bits()) {
        collect_edges();
        EXPECT_EQ(octets_on_txd(answer.start), answer.octets);
        EXPECT_EQ(uart_.txd(), pins::PinLevel::z);
        txd_.clear();
    }
    last_answer_ = answer;
    return answer;
}

std::string Bench::listen_text() {
    const std::optional<Answer> answer = listen();
    return answer ? text(answer->octets) : std::string{kSilence};
}

// ---- the bus
// ----------------------------------------------------------------------------------------------------------

void Bench::tell(const Stimulus& stimulus) {
    Ticks begin = std::max(now(), free_ + bits(fdl::kTsynBits + 4));
    if (by_bits()) {
        run_to(begin);
        begin = uart_.next_sample_from(begin);
    }
    run_to(begin);
    if (by_bits()) {
        tell_bits(begin, stimulus);
        request_end_ = free_ = now();
        return;
    }
    chip_.carrier(begin);
    if (recipe_.path == Path::characters || !stimulus.faults.empty() || !stimulus.gaps.empty()) {
        tell_characters(begin, stimulus);
    } else {
        fdl::Transmission t;
        t.assign(begin, bit(), stimulus.octets);
        run_to(t.end());
        chip_.hear(t);
    }
    request_end_ = free_ = now();
}

void Bench::tell_characters(Ticks start, const Stimulus& stimulus) {
    for (std::size_t i = 0; i < stimulus.octets.size(); ++i) {
        std::uint8_t faults = 0;
        for (const Fault& f : stimulus.faults)
            if (f.octet == i) faults |= f.faults;
        const fdl::Character c{start, bit(), stimulus.octets[i], faults};
        run_to(c.end());
        chip_.hear_character(c);
        if (meddler_) meddler_(chip_);
        start = c.end();
        for (const Gap& g : stimulus.gaps)
            if (g.after == i) start += bits(g.bits);
    }
}

/// A bad stop bit is low in its middle and high in its last quarter: else the next start bit would have no edge.
void Bench::send_bits(const fdl::Character& c) {
    const bool parity = fdl::even_parity(c.octet) != ((c.faults & (fdl::fault_parity | fdl::fault_collision)) != 0);
    const unsigned frame = static_cast<unsigned>(c.octet) << 1 | (parity ? 1u << 9 : 0u) | ((c.faults & fdl::fault_stop) == 0 ? 1u << 10 : 0u);
    const auto put = [&](Ticks at, bool high) {
        run_to(at);
        uart_.set_rxd(chip_, at, pins::to_level(high));
        uart_.sample(chip_);
        if (meddler_) meddler_(chip_);
    };
    for (unsigned n = 0; n < 11; ++n) put(c.start + bits(n), ((frame >> n) & 1u) != 0);
    put(c.end() - Ticks{bit().n / 4}, true);
    run_to(c.end());
}

void Bench::tell_bits(Ticks start, const Stimulus& stimulus) {
    for (std::size_t i = 0; i < stimulus.octets.size(); ++i) {
        std::uint8_t faults = 0;
        for (const Fault& f : stimulus.faults)
            if (f.octet == i) faults |= f.faults;
        const fdl::Character c{start, bit(), stimulus.octets[i], faults};
        run_to(start);
        send_bits(c);
        start = c.end();
        for (const Gap& g : stimulus.gaps)
            if (g.after == i) start += bits(g.bits);
    }
}

Octets Bench::request(std::uint8_t sa, std::uint8_t fc, std::optional<std::uint8_t> dsap, const Octets& data) const {
    const std::uint8_t ts = chip_.online() ? chip_.address() : recipe_.ts;
    Octets unit;
    if (dsap) unit = {*dsap, 0x3E};
    unit.insert(unit.end(), data.begin(), data.end());
    const unsigned ext = dsap ? 0x80u : 0u;
    Octets out(fdl::kMaxTelegram);
    out.resize(fdl::encode(out, static_cast<std::uint8_t>(ts | ext), static_cast<std::uint8_t>(sa | ext), fc, unit));
    return out;
}

Octets Bench::with_fcb(Octets request) const {
    const std::size_t k = fc_index(request);
    if (request.size() <= k || !counts_frames(request[k])) return request;
    const bool valid = (request[k] & 0x10u) != 0, fcb = (request[k] & 0x20u) != 0;
    if (!valid || !last_sa_ || *last_sa_ != (request[k - 1] & 0x7Fu) || fcb != last_fcb_) return request;
    request[k] ^= 0x20u;
    std::uint8_t& fcs = request[request.size() - 2];
    fcs = static_cast<std::uint8_t>(fcb ? fcs - 0x20 : fcs + 0x20);
    return request;
}

void Bench::remember(const Octets& request) {
    last_request_ = request;
    const std::size_t k = fc_index(request);
    if (request.size() <= k || !fdl::decode(request)) return;
    if (!counts_frames(request[k]) || (request[k - 2] & 0x7Fu) == fdl::kBroadcast) return;
    last_fcb_ = (request[k] & 0x20u) != 0;
    last_sa_ = (request[k] & 0x30u) != 0 ? std::optional<std::uint8_t>{request[k - 1] & 0x7Fu} : std::nullopt;
}

std::string Bench::send(const Octets& octets) {
    remember(octets);
    tell(Stimulus{octets, {}, {}});
    return listen_text();
}

std::string Bench::ask(const Octets& request) { return send(with_fcb(request)); }

std::string Bench::ask_verbatim(std::string_view request) { return send(hex(request)); }

std::string Bench::ask_again() { return send(last_request_); }

void Bench::find_baud() {
    const Ticks limit = now() + 6_s;
    const Octets status = request(2, 0x49, std::nullopt, {});
    while (chip_.wd_state() == chip::WdState::baud_search && now() < limit) {
        tell(Stimulus{status, {}, {}});
        run(by_bits() ? bits(1) : 4_clk);  // the grid may have started again in the middle of it
    }
    EXPECT_LT(now(), limit) << "no baud rate found";
    run(bits(fdl::kTsynBits + 4));
}

}  // namespace dpchip::bench
