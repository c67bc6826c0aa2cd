// SPDX-License-Identifier: Apache-2.0
// --state-dir: an address given by Set_Slave_Add survives the program.
#include <csignal>
#include <filesystem>
#include <fstream>

#include <unistd.h>

#include <gtest/gtest.h>

#include <dpchip/cli/live_master.hpp>

#include "cli/process.hpp"
#include "support/golden.hpp"

namespace {

using dpchip::cli::LineConfig;
using dpchip::cli::LiveMaster;
using dpchip::master::Job;
using dpchip::test::Program;
using dpchip::test::run;
namespace core = dpchip::core;
namespace fs = std::filesystem;

/// Repeats a job until it is answered well: a slave that searches the baud rate is silent at first.
bool ask(LiveMaster& live, const Job& wanted) {
    Job job = wanted;
    live.master().submit(job);
    const bool done = live.run_until(
        [&] {
            if (job.finished() && !job.good()) {
                job = wanted;
                live.master().submit(job);
            }
            return job.good();
        },
        core::seconds(30));
    live.master().cancel(job);
    return done;
}

class StateDir : public testing::Test {
protected:
    StateDir() { fs::remove_all(folder_); }
    ~StateDir() override {
        std::error_code error;
        fs::remove_all(folder_, error);
    }
    std::vector<std::string> serve() const {
        return {"serve", "--baud", "12M", "--state-dir", folder_.string(), "--gsd", "builtin:remote_io", "--module", "8 DI", "--address", "126", "--name", "New one"};
    }
    fs::path file() const { return folder_ / "New_one.toml"; }

    fs::path folder_ = fs::temp_directory_path() / ("dpchip_state_" + std::to_string(::getpid()));
};

TEST_F(StateDir, keeps_the_address_of_set_slave_add_over_a_restart) {
    {
        Program server{serve()};
        LineConfig config;
        config.line = server.line().substr(10);
        config.baud = dpchip::fdl::BaudCode::mbit_12;
        LiveMaster live{config, {.mode = dpchip::master::Mode::stop}};
        ASSERT_TRUE(ask(live, Job::slave_diag(126)));
        ASSERT_TRUE(ask(live, Job::set_slave_add(126, {9, 0xFFF0, false, {}})));
        EXPECT_TRUE(ask(live, Job::slave_diag(9)));
        server.signal(SIGTERM);
        ASSERT_EQ(server.wait(), 0);
    }
    EXPECT_NE(dpchip::test::read_file(file()).find("address = 9"), std::string::npos);
    EXPECT_FALSE(fs::exists(file().string() + ".new"));
    Program server{serve()};
    const std::string path = server.line().substr(10);
    EXPECT_EQ(run({"master", "diag", "--line", path, "--baud", "12M", "--station", "9", "--timeout", "60"}).code, 0);
}

TEST_F(StateDir, names_a_damaged_file_by_its_line) {
    fs::create_directories(folder_);
    std::ofstream(file()) << "address = 9\nno_add_change = false\nident = 0x4711\n";
    const auto other = run(serve());
    EXPECT_EQ(other.code, 4);
    EXPECT_NE(other.err.find("New_one.toml:3:9: error:"), std::string::npos) << other.err;
    std::ofstream(file()) << "address = 900\n";
    const auto damaged = run(serve());
    EXPECT_EQ(damaged.code, 4);
    EXPECT_NE(damaged.err.find("New_one.toml:1:11: error:"), std::string::npos) << damaged.err;
}

}  // namespace
