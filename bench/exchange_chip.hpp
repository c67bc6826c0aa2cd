// SPDX-License-Identifier: Apache-2.0
// A chip brought to DATA-EXCH by hand, for benchmarks that want the chip and nothing else.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include <dpchip/chip/chip.hpp>
#include <dpchip/fdl/telegram.hpp>

namespace dpchip::bench {

/// A VPC3+C at address 8 with `octets` outputs and as many inputs, owned by master 2, at 12 Mbit/s.
template <class Trace>
class ExchangeChip {
public:
    explicit ExchangeChip(std::uint8_t octets) : chip_{regmap::Variant::vpc3c} {
        set_up(octets);
        start_up();
        for (std::size_t i = 0; i < octets; ++i) outputs_[i] = static_cast<std::uint8_t>(i);
        for (const bool fcb : {false, true}) encode(request_[fcb], fdl::request_fc(fdl::Request::srd_high, fcb, true), {outputs_.data(), octets});
    }

    /// One Data_Exchange: request in, answer out. Returns the octets of the answer.
    std::size_t exchange() {
        fcb_ = !fcb_;
        fdl::Transmission& request = request_[fcb_];
        request.start = chip_.now() + bit_ * 76;
        run(request);
        return answer_.length;
    }

    chip::Chip<Trace>& chip() { return chip_; }
    const fdl::Transmission& request() const { return request_[0]; }
    const fdl::Transmission& answer() const { return answer_; }

private:
    void set_up(std::uint8_t octets) {
        namespace org = regmap::org;
        const auto cell = [this](std::uint16_t address, unsigned value) { chip_.write(address, static_cast<std::uint8_t>(value)); };
        cell(0x0C, 0x81);
        cell(0x07, 0x01);
        cell(org::r_ts_adr, 8);
        cell(org::r_user_wd_value_high, 0);
        cell(org::r_ident_high, 0x47);
        cell(org::r_ident_low, 0x11);
        unsigned segment = 8;
        const auto buffer = [&](std::uint16_t pointer) { cell(pointer, segment); segment += 16; };
        for (const auto p : {org::r_dout_buf_ptr1, org::r_dout_buf_ptr2, org::r_dout_buf_ptr3, org::r_din_buf_ptr1, org::r_din_buf_ptr2,
                             org::r_din_buf_ptr3, org::r_diag_buf_ptr1, org::r_diag_buf_ptr2, org::r_aux_buf_ptr1, org::r_prm_buf_ptr,
                             org::r_cfg_buf_ptr, org::r_read_cfg_buf_ptr})
            buffer(p);
        for (const auto l : {org::r_len_diag_buf1, org::r_len_diag_buf2}) cell(l, 6);
        cell(org::r_len_cntrl_buf1, 64);
        cell(org::r_len_dout_buf, octets);
        cell(org::r_len_din_buf, octets);
        cell(0x08, 0x01);
    }

    void start_up() {
        chip_.advance(core::milliseconds(1));
        tell(request_fc(), 0, {});
        tell(fdl::request_fc(fdl::Request::srd_high, true, false), 61, std::array<std::uint8_t, 7>{0x80, 1, 1, 11, 0x47, 0x11, 0});
        tell(fdl::request_fc(fdl::Request::srd_high, false, true), 62, std::array<std::uint8_t, 2>{0xD1, 0xE1});
        static_cast<void>(chip_.read(0x10));
        fcb_ = true;
    }

    static std::uint8_t request_fc() { return fdl::request_fc(fdl::Request::fdl_status, false, false); }

    void tell(std::uint8_t fc, std::uint8_t sap, std::span<const std::uint8_t> data) {
        fdl::Transmission t{};
        t.bit = bit_;
        t.start = chip_.now() + bit_ * 100;
        t.length = static_cast<std::uint16_t>(sap == 0 ? fdl::encode_sd1(t.octets, 8, 2, fc)
                                                       : fdl::encode(t.octets, fdl::SapTelegram{8, 2, fc, sap, 62, data}));
        run(t);
    }

    void encode(fdl::Transmission& t, std::uint8_t fc, std::span<const std::uint8_t> outputs) const {
        t = {};
        t.bit = bit_;
        t.length = static_cast<std::uint16_t>(fdl::encode(t.octets, 8, 2, fc, outputs));
    }

    void run(const fdl::Transmission& t) {
        chip_.advance(t.end());
        chip_.hear(t);
        while (chip_.state().timers[static_cast<std::size_t>(chip::Timer::telegram)] != core::kNever || answer_pending()) {
            chip_.advance(chip_.next());
            static_cast<void>(chip_.take(answer_));
        }
    }
    bool answer_pending() const {
        for (const auto timer : {chip::Timer::rts_on, chip::Timer::answer_start, chip::Timer::answer_end, chip::Timer::rts_off})
            if (chip_.state().timers[static_cast<std::size_t>(timer)] != core::kNever) return true;
        return false;
    }

    chip::Chip<Trace> chip_;
    core::Ticks bit_ = fdl::baud(fdl::BaudCode::mbit_12).bit;
    std::array<std::uint8_t, 244> outputs_{};
    std::array<fdl::Transmission, 2> request_{};
    fdl::Transmission answer_{};
    bool fcb_ = false;

};

}  // namespace dpchip::bench
