// SPDX-License-Identifier: Apache-2.0
// Where the buffers lie: inside the RAM, on segments, apart from each other; and which length is named when they do not fit.
#include <gtest/gtest.h>

#include <random>
#include <string>
#include <vector>

#include <dpchip/driver/layout.hpp>

namespace dpchip::driver {
namespace {

constexpr std::uint8_t kCfg[]{0x11, 0x21};

Config station() {
    Config c;
    c.address = 8;
    c.ident = 0x4711;
    c.cfg = kCfg;
    c.max_prm = 20;
    return c;
}

struct Piece {
    std::uint8_t segment;
    std::uint8_t octets;
};

std::vector<Piece> pieces(const Config& c, const Layout& l) {
    std::vector<Piece> all{{l.sap_list, 1}, {l.cfg, l.cfg_octets}, {l.read_cfg, l.cfg_octets}, {l.prm, l.prm_octets},
                           {l.aux[0], l.aux_octets[0]}, {l.aux[1], l.aux_octets[1]}, {l.ssa, l.ssa_octets}};
    for (int i = 0; i < 3; ++i) {
        all.push_back({l.dout[static_cast<std::size_t>(i)], l.max_outputs});
        all.push_back({l.din[static_cast<std::size_t>(i)], l.max_inputs});
    }
    for (const std::uint8_t s : l.diag) all.push_back({s, c.max_diag});
    return all;
}

TEST(Layout, IsAConstantExpressionAndCountsWhatCfgSays) {
    static constexpr std::uint8_t cfg[]{0x13, 0x27};
    constexpr Layout l = lay_out({.address = 3, .cfg = cfg});
    static_assert(l.error == ConfigError::none && l.inputs == 4 && l.outputs == 8 && l.sap_list == 8);
    EXPECT_EQ(l.aux_sel, 0x06);
}

TEST(Layout, BuffersNeverOverlapAndNeverLeaveTheRam) {
    std::mt19937 random{20240611};
    const auto upto = [&](unsigned low, unsigned high) { return static_cast<std::uint8_t>(low + random() % (high - low + 1)); };
    int fitted = 0, refused = 0;
    for (int round = 0; round < 20000; ++round) {
        Config c = station();
        constexpr RamSize sizes[]{RamSize::bytes_1536, RamSize::bytes_2048, RamSize::bytes_4096};
        c.ram = sizes[random() % 3];
        if (c.ram == RamSize::bytes_1536) c.variant = Variant::apc3;
        c.max_inputs = upto(0, 244);
        c.max_outputs = upto(0, 244);
        c.max_cfg = upto(2, random() % 2 ? 244 : 20);
        c.max_prm = upto(7, random() % 2 ? 244 : 30);
        c.max_diag = upto(6, random() % 2 ? 244 : 30);
        c.set_slave_add = random() % 2 != 0;
        c.max_ssa = upto(4, random() % 2 ? 244 : 12);
        c.spec_prm_buf_mode = random() % 3 == 0;
        c.aux = static_cast<AuxUse>(random() % 3);
        const Layout l = lay_out(c);
        if (l.error != ConfigError::none) {
            EXPECT_GE(l.error, ConfigError::dout_space) << name(l.error);
            ++refused;
            continue;
        }
        ++fitted;
        std::vector<int> taken(l.ram_bytes, 0);
        for (const Piece& p : pieces(c, l))
            for (unsigned i = 0; i < p.octets; ++i) {
                const unsigned a = static_cast<unsigned>(l.address(p.segment)) + i;
                ASSERT_GE(a, 0x40u);
                ASSERT_LT(a, l.ram_bytes);
                ASSERT_EQ(taken[a]++, 0) << "round " << round << " address " << a;
            }
        ASSERT_LE(l.used_bytes, l.ram_bytes);
        // Buffers that are exchanged with each other are equally long (6.1).
        const std::uint8_t aux_of_prm = l.aux_octets[l.aux_sel & 1u], aux_of_cfg = l.aux_octets[l.aux_sel >> 1 & 1u];
        if (!c.spec_prm_buf_mode) { EXPECT_EQ(aux_of_prm, l.prm_octets); }
        EXPECT_EQ(aux_of_cfg, l.cfg_octets);
        if (c.set_slave_add) { EXPECT_EQ(l.aux_octets[l.aux_sel >> 2 & 1u], l.ssa_octets); }
        EXPECT_GE(l.prm_octets, c.max_prm);
        EXPECT_GE(l.cfg_octets, c.max_cfg);
        EXPECT_NE(l.aux_octets[0], 0);
    }
    EXPECT_GT(fitted, 1000);
    EXPECT_GT(refused, 1000);
}

struct Refused {
    const char* what;
    void (*change)(Config&);
    ConfigError error;
};

constexpr std::uint8_t kTruncated[]{0x40};
constexpr std::uint8_t kTooMany[]{0x5F, 0x5F, 0x5F, 0x5F, 0x5F, 0x5F, 0x5F, 0x5F};

TEST(Layout, EveryRefusalNamesWhatIsAtFault) {
    const Refused rows[]{
        {"address", [](Config& c) { c.address = 127; }, ConfigError::address},
        {"126", [](Config& c) { c.address = 126; }, ConfigError::address_126},
        {"126 with SSA", [](Config& c) { c.address = 126; c.set_slave_add = true; }, ConfigError::none},
        {"no cfg", [](Config& c) { c.cfg = {}; }, ConfigError::cfg_octets},
        {"truncated cfg", [](Config& c) { c.cfg = kTruncated; }, ConfigError::cfg_octets},
        {"256 octets of inputs", [](Config& c) { c.cfg = kTooMany; }, ConfigError::cfg_octets},
        {"cfg longer than its buffer", [](Config& c) { c.max_cfg = 1; }, ConfigError::cfg_too_long},
        {"max_cfg", [](Config& c) { c.max_cfg = 245; }, ConfigError::cfg_too_long},
        {"max_inputs", [](Config& c) { c.max_inputs = 245; }, ConfigError::inputs_too_long},
        {"max_outputs", [](Config& c) { c.max_outputs = 245; }, ConfigError::outputs_too_long},
        {"prm 6", [](Config& c) { c.max_prm = 6; }, ConfigError::prm_length},
        {"prm 245", [](Config& c) { c.max_prm = 245; }, ConfigError::prm_length},
        {"prm rules", [](Config& c) { c.max_prm = 9; c.prm_rules.min_octets = 3; }, ConfigError::prm_length},
        {"diag 5", [](Config& c) { c.max_diag = 5; }, ConfigError::diag_length},
        {"diag 245", [](Config& c) { c.max_diag = 245; }, ConfigError::diag_length},
        {"ssa 3", [](Config& c) { c.set_slave_add = true; c.max_ssa = 3; }, ConfigError::ssa_length},
        {"4 KB on an APC3", [](Config& c) { c.variant = Variant::apc3; c.ram = RamSize::bytes_4096; }, ConfigError::ram_size},
        {"2 KB on an APC3", [](Config& c) { c.variant = Variant::apc3; }, ConfigError::ram_size},
        {"1.5 KB on a VPC3+C", [](Config& c) { c.ram = RamSize::bytes_1536; }, ConfigError::ram_size},
        {"4 KB on step A", [](Config& c) { c.variant = Variant::vpc3a; c.ram = RamSize::bytes_4096; }, ConfigError::ram_size},
        {"timer on an APC3", [](Config& c) { c.variant = Variant::apc3; c.ram = RamSize::bytes_1536; c.user_timer = UserTimer::ms_1; }, ConfigError::not_in_this_chip},
        {"DX_Int on an APC3", [](Config& c) { c.variant = Variant::apc3; c.ram = RamSize::bytes_1536; c.dx_int = DxInt::always; }, ConfigError::not_in_this_chip},
        {"GC_Int on an APC3", [](Config& c) { c.variant = Variant::apc3; c.ram = RamSize::bytes_1536; c.gc_int = GcInt::every; }, ConfigError::not_in_this_chip},
        {"Mode 3 on step A", [](Config& c) { c.variant = Variant::vpc3a; c.dx_int = DxInt::on_change; }, ConfigError::not_in_this_chip},
        {"SAP 53 on step A", [](Config& c) { c.variant = Variant::vpc3a; c.set_ext_prm = true; }, ConfigError::not_in_this_chip},
        {"PrmCmd on an APC3", [](Config& c) { c.variant = Variant::apc3; c.ram = RamSize::bytes_1536; c.prm_cmd_supported = true; }, ConfigError::not_in_this_chip},
        {"SAP 53, one Aux", [](Config& c) { c.set_ext_prm = true; c.aux = AuxUse::all_on_1; }, ConfigError::ext_prm_buffers},
        {"SAP 53, special buffer", [](Config& c) { c.set_ext_prm = true; c.spec_prm_buf_mode = true; }, ConfigError::ext_prm_buffers},
        // Space: 2048 - 64 - 8 octets are there; the lengths below end in the buffer that is named.
        {"244 in, 244 out fit", [](Config& c) { c.max_inputs = c.max_outputs = 244; }, ConfigError::none},
        {"din", [](Config& c) { c.variant = Variant::apc3; c.ram = RamSize::bytes_1536; c.max_inputs = c.max_outputs = 244; }, ConfigError::din_space},
        {"diag", [](Config& c) { c.max_inputs = c.max_outputs = 244; c.max_diag = 244; }, ConfigError::diag_space},
        {"cfg", [](Config& c) { c.max_inputs = c.max_outputs = 244; c.max_cfg = 244; }, ConfigError::cfg_space},
        {"prm", [](Config& c) { c.max_inputs = c.max_outputs = 240; c.max_cfg = 176; c.max_prm = 244; }, ConfigError::prm_space},
        {"aux", [](Config& c) { c.max_inputs = c.max_outputs = 244; c.max_prm = 244; }, ConfigError::aux_space},
        {"ssa", [](Config& c) { c.max_inputs = 244; c.max_outputs = 200; c.set_slave_add = true; c.max_ssa = 144; }, ConfigError::ssa_space},
    };
    for (const Refused& row : rows) {
        Config c = station();
        row.change(c);
        EXPECT_EQ(lay_out(c).error, row.error) << row.what << ": " << name(lay_out(c).error);
        EXPECT_NE(std::string{name(row.error)}, "");
    }
}

}  // namespace
}  // namespace dpchip::driver
