// SPDX-License-Identifier: Apache-2.0
// A line with a master, scripted slaves, a judge and a recorder, for tests of the master.
#pragma once

#include <memory>
#include <vector>

#include <gtest/gtest.h>

#include "master/scripted_slave.hpp"
#include "segment/talker.hpp"

#include <dpchip/master/master.hpp>
#include <dpchip/segment/judge.hpp>

namespace dpchip::test {

inline master::SlaveConfig config_of(const ScriptedSlave& s) {
    master::SlaveConfig c;
    c.address = s.own;
    c.ident = s.ident;
    c.cfg = s.cfg;
    c.input_octets = s.inputs;
    c.output_octets = s.outputs;
    return c;
}

struct Bus {
    explicit Bus(const master::MasterConfig& config = {}) : master{config} {
        EXPECT_TRUE(line.attach(master, "master"));
        line.observe(judge);
    }
    ~Bus() {
        if (!judge_checked) return;
        for (const segment::Violated& v : judge.violations())
            ADD_FAILURE() << segment::name(v.rule) << " at " << core::to_ns(v.at) << " ns, " << v.bits << " bits, sender " << v.sender;
    }
    Bus(const Bus&) = delete;
    Bus& operator=(const Bus&) = delete;

    /// Puts a slave on the line and, unless told otherwise, into the master's list.
    ScriptedSlave& plug(ScriptedSlave slave, bool configured = true) {
        slave.rate = master.config().baud;
        slaves.push_back(std::make_unique<ScriptedSlave>(std::move(slave)));
        EXPECT_TRUE(line.attach(*slaves.back()));
        EXPECT_TRUE(!configured || master.add(config_of(*slaves.back())));
        return *slaves.back();
    }
    bool start(Ticks limit = core::seconds(60)) {
        return line.run_until([&] { return master.all_exchanging(); }, limit);
    }
    /// Runs until so many more cycles are complete.
    void cycles(std::uint64_t n) {
        const std::uint64_t end = master.cycle().cycles + n;
        ASSERT_TRUE(line.run_until([&] { return master.cycle().cycles >= end; }, core::seconds(10'000)));
    }

    segment::Segment line;
    master::Master master;
    std::vector<std::unique_ptr<ScriptedSlave>> slaves;
    segment::Judge judge;
    bool judge_checked = true;
};

}  // namespace dpchip::test
