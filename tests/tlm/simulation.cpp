// SPDX-License-Identifier: Apache-2.0
// main(), sc_main() and the modules that the tests have in common.
#include "tlm/simulation.hpp"

#include <cstdio>
#include <cstdlib>

#include <sys/wait.h>
#include <unistd.h>

namespace {
const std::function<void()>* the_body = nullptr;
}  // namespace

int sc_main(int, char*[]) {
    (*the_body)();
    return testing::Test::HasFailure() ? 1 : 0;
}

int main(int argc, char** argv) {
    setenv("SYSTEMC_DISABLE_COPYRIGHT_MESSAGE", "1", 1);
    testing::InitGoogleTest(&argc, argv);
    return RUN_ALL_TESTS();
}

namespace dpchip::tlm::test {

namespace {

/// Ends the child. SystemC threads that never return leave their locals behind, which is no leak worth a report.
[[noreturn]] void leave(int code) {
    std::fflush(nullptr);
#ifdef __SANITIZE_ADDRESS__
    _exit(code);
#else
    std::exit(code);
#endif
}

}  // namespace

void simulate(const std::function<void()>& body) {
    std::fflush(nullptr);
    const pid_t child = fork();
    ASSERT_GE(child, 0);
    if (child == 0) {
        the_body = &body;
        char program[] = "test_tlm";
        char* arguments[] = {program, nullptr};
        leave(sc_core::sc_elab_and_sim(1, arguments));
    }
    int status = 0;
    ASSERT_EQ(waitpid(child, &status, 0), child);
    EXPECT_EQ(status, 0) << "the simulation failed; its messages are above";
}

Board::Board(const sc_core::sc_module_name& name, const ChipSettings& settings, LineChipIf* line)
    : sc_core::sc_module{name}, chip{"chip", settings} {
    using SC_CURRENT_USER_MODULE = Board;
    cpu.bind(chip.bus);
    chip.x_int(x_int);
    chip.xdataexch_sync(xdataexch);
    chip.reset(reset);
    chip.xcts(xcts);
    if (line != nullptr) chip.line(*line);
    SC_THREAD(run);
}

Board::~Board() = default;

void Board::run() {
    if (program) program();
}

::tlm::tlm_response_status Board::transport(::tlm::tlm_command command, std::uint64_t address, std::uint8_t* data, unsigned length) {
    ::tlm::tlm_generic_payload p;
    p.set_command(command);
    p.set_address(address);
    p.set_data_ptr(data);
    p.set_data_length(length);
    p.set_streaming_width(length);
    cpu->b_transport(p, delay);
    return p.get_response_status();
}

std::uint8_t Board::read(std::uint64_t address) {
    std::uint8_t value = 0;
    EXPECT_EQ(transport(::tlm::TLM_READ_COMMAND, address, &value, 1), ::tlm::TLM_OK_RESPONSE);
    return value;
}

void Board::write(std::uint64_t address, std::uint8_t value) {
    EXPECT_EQ(transport(::tlm::TLM_WRITE_COMMAND, address, &value, 1), ::tlm::TLM_OK_RESPONSE);
}

void Board::set_up(std::uint8_t mask_low, std::uint8_t mask_high, std::uint8_t station) {
    const std::pair<std::uint8_t, std::uint8_t> cells[] = {
        {0x1A, 2}, {0x1B, 0x10}, {0x1C, 0x11}, {0x1D, 0x12}, {0x1E, 2}, {0x1F, 0x13}, {0x20, 0x14}, {0x21, 0x15}, {0x24, 6}, {0x25, 6},
        {0x26, 0x16}, {0x27, 0x17}, {0x28, 24}, {0x2B, 0x18}, {0x30, 0x1C}, {0x32, 0x20}, {0x33, 2}, {0x34, 0x24}, {0x17, 0x08},
        {0x40, 0xFF}, {0x06, 0xC0}, {0x07, 0x01}, {0x16, station}, {0x3A, 0x11}, {0x3B, 0x47}, {0x04, mask_low}, {0x05, mask_high}};
    for (const auto& [address, value] : cells) write(address, value);
    write(0x08, 0x01);
}

std::vector<std::uint8_t> Board::memory() const {
    std::vector<std::uint8_t> all(2048);
    for (std::size_t i = 0; i < all.size(); ++i) all[i] = chip.peek(static_cast<std::uint16_t>(i));
    return all;
}

Actor::Actor(const sc_core::sc_module_name& name, std::function<void()> role) : sc_core::sc_module{name}, role_{std::move(role)} {
    using SC_CURRENT_USER_MODULE = Actor;
    SC_THREAD(run);
}

Monitor::Monitor(const sc_core::sc_module_name& name, Line& line) : sc_core::sc_module{name} { line.telegrams.bind(*this); }

void Monitor::write(const Telegram& t) { seen.push_back(t); }

namespace {

std::string& kept() {
    static std::string texts;
    return texts;
}

}  // namespace

Reports::Reports(const char* type) {
    sc_core::sc_report_handler::set_actions(type, sc_core::SC_CACHE_REPORT);
    sc_core::sc_report_handler::set_handler([](const sc_core::sc_report& report, const sc_core::sc_actions& actions) {
        if (actions == sc_core::SC_CACHE_REPORT) kept() += std::string{report.get_msg()} + '\n';
        else sc_core::sc_report_handler::default_handler(report, actions);
    });
}

const std::string& Reports::text() { return kept(); }

void until(const sc_time& time) {
    if (time > sc_core::sc_time_stamp()) sc_core::wait(time - sc_core::sc_time_stamp());
}

}  // namespace dpchip::tlm::test
