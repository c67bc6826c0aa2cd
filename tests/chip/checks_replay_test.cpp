// SPDX-License-Identifier: Apache-2.0
// Exchanges recorded from real slaves, byte for byte: C133 to C136 (reference 8.12), and slave 2 with ident 0CDAH.
#include "checks.hpp"

namespace dpchip::checks {
namespace {

// proves: VPC3C 1-06, VPC3C 2.1-05, VPC3C 2.1-06, VPC3C 6.1-09..12, APC3 1-02..03, APC3 5.1-09..11, APC3 5.2.2-01
TEST_P(Checks, C133_to_C136_the_start_up_of_the_slave_with_ident_0A35_comes_out_as_recorded) {
    Recipe r = recipe();
    r.ident = 0x0A35;
    r.din = 0;
    r.read_cfg = {0x21};
    Bench b{r, Stage::p0};
    {
        SCOPED_TRACE("C133");
        EXPECT_EQ(b.ask_verbatim("68 05 05 68 88 82 6D 3C 3E F1 16"),
                  "68 0B 0B 68 82 88 08 3E 3C 02 05 00 FF 0A 35 D1 16");
    }
    {
        SCOPED_TRACE("C134");
        EXPECT_EQ(b.ask_verbatim("68 13 13 68 88 82 5D 3D 3E B8 1E 01 00 0A 35 01 00 00 00 82 00 00 00 7B 16"), "E5");
        EXPECT_EQ(b.read(control::user_prm_data_okay), 0x00);
    }
    {
        SCOPED_TRACE("C135");
        EXPECT_EQ(b.ask_verbatim("68 06 06 68 88 82 7D 3E 3E 21 24 16"), "E5");
        EXPECT_EQ(b.read(control::user_cfg_data_okay), 0x00);
    }
    {
        SCOPED_TRACE("C136");
        EXPECT_EQ(b.ask_verbatim("68 05 05 68 88 82 5D 3C 3E E1 16"),
                  "68 0B 0B 68 82 88 08 3E 3C 00 0C 00 02 0A 35 D9 16");
    }
    EXPECT_EQ(b.dp_state(), kDataExch);
}

TEST_P(Checks, the_start_up_of_slave_2_with_master_99_comes_out_as_recorded) {
    Recipe r = recipe();
    r.ts = 2;
    r.ident = 0x0CDA;
    Bench b{r, Stage::searching};
    b.run(b.bits(40));
    for (int i = 0; i < 1000 && b.wd_state() == kBaudSearch; ++i)
        EXPECT_EQ(b.ask_verbatim("10 02 63 49 AE 16"), kSilence);
    EXPECT_EQ(b.ask_verbatim("10 02 63 49 AE 16"), "10 63 02 00 65 16");
    EXPECT_EQ(b.ask_verbatim("68 05 05 68 82 E3 6D 3C 3E 4C 16"), "68 0B 0B 68 E3 82 08 3E 3C 02 05 00 FF 0C DA D3 16");
    EXPECT_EQ(b.ask(b.request(99, 0x5D, 0x3D, {0x88, 0x02, 0x05, 0x0B, 0x0C, 0xDA, 0x00})), "E5");
    EXPECT_EQ(b.ask(b.request(99, 0x7D, 0x3E, {0x11, 0x21})), "E5");
    EXPECT_EQ(b.read(control::user_cfg_data_okay), 0x00);
    b.give_inputs("AB CD");
    const Octets answer = hex(b.ask(b.request(99, 0x5D, 0x3C, {})));
    ASSERT_EQ(answer.size(), 17u);
    EXPECT_EQ(text(std::span{answer}.subspan(9, 6)), "00 0C 00 63 0C DA");
}

}  // namespace
}  // namespace dpchip::checks
