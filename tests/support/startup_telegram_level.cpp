// SPDX-License-Identifier: Apache-2.0
// The start-up scenario at telegram level, in C++: what the other ways in are held against.
#include <algorithm>
#include <stdexcept>

#include <dpchip/chip/chip.hpp>
#include <dpchip/regmap/options.hpp>
#include <dpchip/segment/port.hpp>
#include <dpchip/segment/segment.hpp>

#include "startup_firmware.hpp"

namespace dpchip::test::startup {

namespace {

class Board {
public:
    explicit Board(Service service) : service_{service}, firmware_{{this, &Board::read, &Board::write}, service} {
        for (const auto& [name, value] : kOptions)
            if (!regmap::set_option(chip_.options(), name, value)) throw std::logic_error{name};
        master_index_ = *line_.attach(master_, "master");
        chip_index_ = *line_.attach(chip_, "chip");
        line_.observe(*this);
        if (!firmware_.begin()) throw std::logic_error{"the driver refuses the scenario"};
        line_.touch(chip_index_);
    }

    void run_to(core::Ticks end) {
        while (line_.now() < end) {
            if (service_ == Service::interrupt) {
                line_.run_until([this] { return chip_.interrupt_active(); }, end - line_.now());
                if (!chip_.interrupt_active()) continue;
                firmware_.on_interrupt();
            } else {
                const core::Ticks next_poll{(line_.now().n / kPollPeriod + 1) * kPollPeriod};
                line_.advance(std::min(next_poll, end));
                if (line_.now() != next_poll) continue;
                firmware_.poll();
            }
            line_.touch(chip_index_);
        }
    }
    void send(const Request& request) {
        run_to(core::Ticks{request.at});
        line_.settle();
        if (!master_.send_at(line_.now(), request.octets)) throw std::logic_error{"requests overlap"};
        line_.touch(master_index_);
    }
    Result result() {
        for (std::size_t i = 0; i < kMemory; ++i) result_.memory[i] = chip_.peek(static_cast<std::uint16_t>(i));
        return result_;
    }
    void see(const segment::Sighting& s) {
        result_.telegrams.push_back({s.sent.start.n, s.sender == master_index_, Octets(s.sent.bytes().begin(), s.sent.bytes().end())});
    }

private:
    static std::uint8_t read(void* self, std::uint16_t address) { return static_cast<Board*>(self)->here().read(address); }
    static void write(void* self, std::uint16_t address, std::uint8_t value) { static_cast<Board*>(self)->here().write(address, value); }
    chip::Chip<>& here() {
        chip_.advance(line_.now());
        return chip_;
    }

    Service service_;
    segment::Segment line_;
    segment::Port master_{*fdl::baud_from_bits_per_s(kBaud)};
    chip::Chip<> chip_{regmap::Variant::vpc3c};
    Firmware firmware_;
    segment::StationIndex master_index_{}, chip_index_{};
    Result result_;
};

}  // namespace

Result telegram_level(Service service) {
    Board board{service};
    for (const Request& request : requests()) board.send(request);
    board.run_to(core::Ticks{kEnd});
    return board.result();
}

}  // namespace dpchip::test::startup
