// SPDX-License-Identifier: Apache-2.0
// Slaves from GSD files of real devices: each reaches data exchange with the parameters its own file gives, on a VPC3+C
// and, where its RAM is large enough, on an APC3.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <dpchip/gsd/parse.hpp>
#include <dpchip/gsd/user_prm.hpp>
#include <dpchip/slave/virtual_slave.hpp>

#include "slave/bench_master.hpp"
#include "support/shared.hpp"

namespace dpchip::slave {
namespace {

using testing::BenchMaster;
using testing::Octets;

std::string number(std::size_t index) {
    std::string text{"#"};
    text += std::to_string(index + 1);
    return text;
}

/// One module that the station takes alone: the preset ones, or the first that fits and has data.
std::optional<std::vector<std::string>> some_modules(const gsd::Gsd& g) {
    const auto fits = [&](const std::vector<std::string>& names) {
        try {
            const gsd::Configuration c = gsd::configure(g, names);
            return c.input_octets + c.output_octets != 0;
        } catch (const gsd::GsdError&) {
            return false;
        }
    };
    if (fits({})) return std::vector<std::string>{};
    for (std::size_t i = 0; i < g.modules.size(); ++i)
        if (std::vector<std::string> one{number(i)}; fits(one)) return one;
    for (std::size_t i = 0; i < g.modules.size(); ++i)
        for (std::size_t j = 0; j < std::min<std::size_t>(g.modules.size(), 40); ++j)
            if (std::vector<std::string> two{number(j), number(i)}; fits(two)) return two;
    return std::nullopt;
}

void exchange_data(const gsd::Gsd& g, const SlaveSetup& how) {
    VirtualSlave s{g, how};
    BenchMaster m{s, how.address};
    ASSERT_TRUE(m.find_baud());
    ASSERT_EQ(m.set_prm(gsd::user_prm_data(g, s.plan().configuration).octets), Octets{0xE5});
    ASSERT_EQ(m.diag().at(0) & 0x40, 0) << "Prm_Fault";
    ASSERT_EQ(m.chk_cfg(s.plan().configuration.cfg), Octets{0xE5});
    ASSERT_TRUE(m.is_ready());
    Octets outputs(s.outputs().size());
    for (std::size_t i = 0; i < outputs.size(); ++i) outputs[i] = static_cast<std::uint8_t>(i + 1);
    const Octets inputs = m.exchange(outputs);
    if (s.inputs().empty()) {
        EXPECT_EQ(inputs, Octets{0xE5});
    } else {
        Octets expected = outputs;
        expected.resize(s.inputs().size());
        EXPECT_EQ(inputs, expected);
    }
    EXPECT_EQ(Octets(s.outputs().begin(), s.outputs().end()), outputs);
    EXPECT_EQ(s.counters().prm_refused + s.counters().cfg_refused, 0u);
}

TEST(FieldFiles, EveryDeviceReachesDataExchange) {
    const auto folder = test::shared_path("gsd", "slaves from GSD files of real devices");
    if (!folder) return;
    int devices = 0, apc3 = 0, without_modules = 0;
    for (const auto& entry : std::filesystem::directory_iterator{*folder}) {
        const std::string file = entry.path().filename().string();
        SCOPED_TRACE(file);
        const gsd::Gsd g = gsd::load(entry.path().string());
        if (g.modules.empty()) {  // a stand-in for devices without a file
            SlaveSetup how;
            how.address = 5;
            EXPECT_ANY_THROW((VirtualSlave{g, how}));
            ++without_modules;
            continue;
        }
        const auto modules = some_modules(g);
        if (!modules) {
            ADD_FAILURE() << "no module fits";
            continue;
        }
        SlaveSetup how;
        how.modules = *modules;
        how.address = 5;
        how.options.baud_probe_ms.fill(1);
        exchange_data(g, how);
        ++devices;
        how.variant = regmap::Variant::apc3;
        try {
            exchange_data(g, how);
            ++apc3;
        } catch (const SlaveError& e) {
            EXPECT_EQ(e.kind(), SlaveError::Kind::ram) << e.what();
        }
    }
    EXPECT_EQ(devices, 41);
    EXPECT_EQ(without_modules, 1);
    EXPECT_GE(apc3, 38);
}

}  // namespace
}  // namespace dpchip::slave
