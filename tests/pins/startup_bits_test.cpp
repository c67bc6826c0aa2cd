// SPDX-License-Identifier: Apache-2.0
// The start-up to data exchange with bits on the line and accesses that take no time: it ends as at telegram level. The
// scenario's requests begin a few ticks beside the sampling grid; the chip's answers are those of the telegram level, put on
// the next sample, to the tick.
#include <gtest/gtest.h>

#include <algorithm>

#include <dpchip/pins/bit_line.hpp>
#include <dpchip/regmap/options.hpp>
#include <dpchip/segment/port.hpp>

#include "support/startup_firmware.hpp"

namespace {

using namespace dpchip;
using core::Ticks;
namespace startup = test::startup;

class Board {
public:
    explicit Board(startup::Service service) : service_{service}, firmware_{{this, &Board::read, &Board::write}, service} {
        for (const auto& [name, value] : startup::kOptions) EXPECT_TRUE(regmap::set_option(chip_.options(), name, value));
        line_.attach(adapter_);
        line_.attach(station_);
        EXPECT_TRUE(firmware_.begin());
    }
    startup::Result run() {
        for (const startup::Request& request : startup::requests()) {
            run_to(Ticks{request.at});
            result_.telegrams.push_back({request.at, true, request.octets});
            EXPECT_TRUE(master_.send_at(line_.now(), request.octets));
        }
        run_to(Ticks{startup::kEnd});
        for (std::size_t i = 0; i < startup::kMemory; ++i) result_.memory[i] = chip_.peek(static_cast<std::uint16_t>(i));
        return result_;
    }

private:
    static std::uint8_t read(void* self, std::uint16_t address) { return static_cast<Board*>(self)->chip_.read(address); }
    static void write(void* self, std::uint16_t address, std::uint8_t value) { static_cast<Board*>(self)->chip_.write(address, value); }

    void step(Ticks to) {
        line_.advance(to);
        while (master_.pending()) {
            const segment::Transmission t = master_.receive();
            EXPECT_FALSE(t.damaged);
            result_.telegrams.push_back({t.start.n, false, startup::Octets(t.bytes().begin(), t.bytes().end())});
        }
    }
    void run_to(Ticks end) {
        while (line_.now() < end) {
            if (service_ == startup::Service::interrupt) {
                step(std::min(end, std::max(line_.next(), line_.now() + Ticks{1})));
                if (chip_.interrupt_active()) firmware_.on_interrupt();
            } else {
                const Ticks poll{(line_.now().n / startup::kPollPeriod + 1) * startup::kPollPeriod};
                step(std::min(poll, end));
                if (line_.now() == poll) firmware_.poll();
            }
        }
    }

    startup::Service service_;
    pins::BitLine line_;
    chip::Chip<> chip_{regmap::Variant::vpc3c};
    pins::Uart<core::RingTrace> uart_;
    pins::UartStation<chip::Chip<>> station_{chip_, uart_};
    segment::Port master_{*fdl::baud_from_bits_per_s(startup::kBaud)};
    pins::TelegramAdapter<segment::Port> adapter_{master_, *fdl::baud_from_bits_per_s(startup::kBaud)};
    startup::Firmware firmware_;
    startup::Result result_;
};

TEST(StartUpBitByBit, ends_as_at_telegram_level_with_each_answer_on_the_sample_behind_its_tick_there) {
    const startup::Ticks quarter = fdl::baud(*fdl::baud_from_bits_per_s(startup::kBaud)).bit.n / 4;
    for (const startup::Service service : {startup::Service::interrupt, startup::Service::polling}) {
        startup::Result reference = startup::telegram_level(service);
        for (startup::Seen& seen : reference.telegrams)
            if (!seen.own) seen.start = (seen.start + quarter - 1) / quarter * quarter;
        const startup::Result bits = Board{service}.run();
        EXPECT_TRUE(bits == reference) << startup::difference(bits, reference);
        EXPECT_GT(reference.telegrams.size(), 10u);
    }
}

}  // namespace
