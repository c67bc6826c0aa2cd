// SPDX-License-Identifier: Apache-2.0
// The SAP list: checks C113 to C118 at the chip (reference 5.1, 5.2, 8.11). C117 and C119 to C122 are the driver's too.
#include "checks.hpp"

namespace dpchip::checks {
namespace {

constexpr std::string_view kRead = "68 09 09 68 88 82 5D 33 33 5E 01 10 04 40 16";
constexpr std::string_view kPoll = "68 05 05 68 88 82 7D 33 33 ED 16";
constexpr std::uint8_t kUser = 0x80, kInd = 0x40, kResp = 0x20;

/// A bench in DATA-EXCH with one SAP in its list and three buffers of their own, as firmware would set them up.
class SapBench : public Bench {
public:
    explicit SapBench(const Recipe& r, Octets entry) : Bench{r, Stage::p2} {
        list_ = static_cast<std::uint16_t>(peek(org::sap_list_ptr) << 3);
        put(list_, entry);
        write(static_cast<std::uint16_t>(list_ + entry.size()), 0xFF);
        for (const std::uint16_t b : {kInd0, kInd1, kRespBuf}) put(b, {0, 32, 0, 0});
        acknowledge();
        run(microsecond());
        acknowledge();
    }
    static Octets entry(std::uint8_t sap, std::uint8_t sa = 0x7F, std::uint8_t ssap = 0x7F, std::uint8_t service = 0x0B) {
        return {sap, sa, ssap, service, kInd0 >> 3, kInd1 >> 3, kRespBuf >> 3};
    }
    void put(std::uint16_t at, const Octets& octets) {
        for (const std::uint8_t o : octets) write(at++, o);
    }
    /// The firmware gives a response: the control octet last.
    void respond(const Octets& data, std::uint8_t fc = 0x08) {
        put(kRespBuf + 2, {static_cast<std::uint8_t>(data.size()), fc});
        put(kRespBuf + 4, data);
        write(kRespBuf, kUser | kResp);
    }
    std::uint16_t list() const { return list_; }
    static Ticks microsecond() { return core::microseconds(1); }

    static constexpr std::uint16_t kInd0 = 0x700, kInd1 = 0x740, kRespBuf = 0x780;

private:
    std::uint16_t list_{};
};

// proves: VPC3C 7.2.1-05, VPC3C 7.2.1-10, VPC3C 7.2.1-14, VPC3C 7.2.1-25..27, VPC3C 7.2.1-31, VPC3C 7.2.1-32
// proves: VPC3C 7.2.1-33, VPC3C 7.2.1-37, VPC3C 7.2.1-38, VPC3C 7.2.1-43, VPC3C 7.2.1-46, VPC3C 5.3.1-12
TEST_P(ChecksStepBC, C113_a_request_with_data_is_stored_and_indicated) {
    SapBench b{recipe(), SapBench::entry(0x33)};
    EXPECT_EQ(b.ask(kRead), kSc);
    EXPECT_EQ(b.irr(), irq::fdl_ind);
    EXPECT_EQ(text(b.ram(SapBench::kInd0, 8)), "C0 20 04 0D 5E 01 10 04");
    EXPECT_EQ(text(b.ram(b.list(), 3)), "33 82 33") << "the requester is written into the entry";
}

// proves: VPC3C 7.2.1-06, VPC3C 7.2.1-07, VPC3C 7.2.1-14, VPC3C 7.2.1-24, VPC3C 7.2.1-28, VPC3C 7.2.1-39..42
// proves: VPC3C 7.2.1-44, VPC3C 7.2.1-45, VPC3C 7.2.1-50..52, VPC3C 5.3.1-13
TEST_P(ChecksStepBC, C114_a_poll_gets_SC_until_the_response_is_there) {
    SapBench b{recipe(), SapBench::entry(0x33)};
    EXPECT_EQ(b.ask(kRead), kSc);
    b.acknowledge();
    EXPECT_EQ(b.ask(kPoll), kSc);
    EXPECT_EQ(b.irr(), 0) << "polls are not indicated";
    b.respond({0x5E, 0x01, 0x10, 0x04, 0x01, 0x02, 0x03, 0x04});
    EXPECT_EQ(b.ask(kPoll), "68 0D 0D 68 82 88 08 33 33 5E 01 10 04 01 02 03 04 F5 16");
    EXPECT_EQ(b.irr(), irq::poll_end_ind);
    EXPECT_EQ(b.peek(SapBench::kRespBuf), 0x00);
    EXPECT_EQ(b.peek(b.list()), 0xB3) << "Response_Sent";
    EXPECT_EQ(b.ask(kPoll), kSc);
}

// proves: VPC3C 7.2.1-16, VPC3C 7.2.1-35
TEST_P(ChecksStepBC, C115_another_master_is_refused) {
    SapBench b{recipe(), SapBench::entry(0x33, 0x82)};
    EXPECT_EQ(b.ask("68 09 09 68 88 83 6D 33 33 5E 01 10 04 51 16"), "10 03 08 03 0E 16");
    EXPECT_EQ(b.irr(), 0);
    EXPECT_EQ(b.ask(b.request(3, 0x6D, 0x33, {})), "10 03 08 03 0E 16") << "and may not poll either";
}

// proves: VPC3C 7.2.1-22, VPC3C 7.2.1-23, VPC3C 7.2.1-25, VPC3C 7.2.1-30, VPC3C 7.2.1-36
TEST_P(ChecksStepBC, C116_without_a_free_indication_buffer_the_answer_is_RR) {
    SapBench b{recipe(), SapBench::entry(0x33)};
    EXPECT_EQ(b.ask(kRead), kSc);
    EXPECT_EQ(b.ask(kRead), kSc) << "Ind_Buf[1] takes the second";
    EXPECT_EQ(text(b.ram(SapBench::kInd1, 8)), "C0 20 04 0D 5E 01 10 04");
    EXPECT_EQ(b.ask(kRead), kRr);
    b.write(SapBench::kInd0, 0);
    b.put(static_cast<std::uint16_t>(b.list() + 1), {0x7F, 0x7F});
    EXPECT_EQ(b.ask(b.request(2, 0x5D, 0x33, Octets(33, 0x55))), kRr) << "longer than Max_Length";
    EXPECT_EQ(b.ask(b.request(2, 0x5D, 0x33, Octets(32, 0x55))), kSc);
}

TEST_P(ChecksStepBC, C117_the_users_answer_goes_out_as_it_is) {
    SapBench b{recipe(), SapBench::entry(0x33)};
    b.ask(kRead);
    b.respond({0xDE, 0x80, 0xB0, 0x00});
    EXPECT_EQ(b.ask("68 05 05 68 88 82 5D 33 33 CD 16"), "68 09 09 68 82 88 08 33 33 DE 80 B0 00 86 16");
    b.respond({0x01}, 0x0A);
    EXPECT_EQ(b.ask("68 05 05 68 88 82 5D 33 33 CD 16"), "68 06 06 68 82 88 0A 33 33 01 7B 16") << "high priority";
}

TEST_P(ChecksStepBC, C118_a_response_that_waits_is_the_immediate_answer_and_the_indication_comes_with_its_end) {
    SapBench b{recipe(), SapBench::entry(0x31)};
    b.respond({0x56, 0x30, 0x00, 0x64});
    b.tell(Stimulus{hex("68 19 19 68 88 82 5D 31 32 57 00 00 00 03 E8 01 00 00 00 00 00 00 02 00 02 00 00 00 00 11 16"), {}, {}});
    b.run(b.bits(5));
    EXPECT_EQ(b.irr(), 0) << "nothing before the answer has been sent";
    EXPECT_EQ(b.peek(SapBench::kInd0), kUser | kInd);
    EXPECT_EQ(b.listen_text(), "68 09 09 68 82 88 08 32 31 56 30 00 64 5F 16");
    EXPECT_EQ(b.irr(), irq::fdl_ind | irq::poll_end_ind);
    EXPECT_EQ(text(b.ram(b.list(), 3)), "B1 82 32");
}

// proves: VPC3C 7.2.1-17, VPC3C 7.2.1-19, VPC3C 7.2.1-39
TEST_P(ChecksStepBC, a_poll_does_not_close_an_open_entry) {
    SapBench b{recipe(), SapBench::entry(0x31)};
    EXPECT_EQ(b.ask(b.request(2, 0x5D, 0x31, {})), kSc);
    EXPECT_EQ(text(b.ram(b.list(), 3)), "31 7F 7F");
}

TEST_P(ChecksStepBC, a_repeated_poll_gets_the_octets_sent_before) {
    SapBench b{recipe(), SapBench::entry(0x33)};
    b.ask(kRead);
    b.respond({0x5E, 0x01});
    const std::string first = b.ask(kPoll);
    b.acknowledge();
    b.respond({0x11, 0x22, 0x33});
    EXPECT_EQ(b.ask_again(), first) << "although the user has written the next response";
    EXPECT_EQ(b.irr(), 0);
    EXPECT_EQ(b.peek(SapBench::kRespBuf), kUser | kResp);
    EXPECT_EQ(b.ask_again(), first);
    EXPECT_NE(b.ask(kPoll), first) << "a new poll gets the new one";
}

TEST_P(ChecksStepBC, a_repeated_poll_that_got_SC_gets_SC_again) {
    SapBench b{recipe(), SapBench::entry(0x33)};
    b.ask(kRead);
    EXPECT_EQ(b.ask(kPoll), kSc);
    b.respond({0x5E});
    EXPECT_EQ(b.ask_again(), kSc);
    EXPECT_NE(b.ask(kPoll), kSc);
}

TEST_P(ChecksStepBC, a_repeated_request_is_not_stored_twice) {
    SapBench b{recipe(), SapBench::entry(0x33)};
    EXPECT_EQ(b.ask(kRead), kSc);
    b.acknowledge();
    EXPECT_EQ(b.ask_again(), kSc);
    EXPECT_EQ(b.irr(), 0);
    EXPECT_EQ(b.peek(SapBench::kInd1), 0);
}

// proves: VPC3C 7.2.1-16, VPC3C 7.2.1-35
TEST_P(ChecksStepBC, a_closed_SAP_and_one_that_is_not_listed_are_not_activated) {
    Octets closed = SapBench::entry(0x33);
    closed[4] = 0;
    SapBench b{recipe(), closed};
    EXPECT_EQ(b.ask(kRead), kRs);
    EXPECT_EQ(b.ask(b.request(2, 0x5D, 0x32, {0x5E, 0, 0, 4})), kRs);
    SapBench locked{recipe(), SapBench::entry(0x33, 0x08)};
    EXPECT_EQ(locked.ask(kRead), kRs) << "the own address locks a SAP";
}

// proves: VPC3C 7.2.1-18, VPC3C 7.2.1-35
TEST_P(ChecksStepBC, Request_SSAP_is_compared_and_a_missing_one_counts_as_40H) {
    SapBench b{recipe(), SapBench::entry(0x33, 0x82, 0x33)};
    EXPECT_EQ(b.ask(kRead), kSc);
    SapBench other{recipe(), SapBench::entry(0x33, 0x82, 0x32)};
    EXPECT_EQ(other.ask(kRead), kRs);
    SapBench none{recipe(), SapBench::entry(0x33, 0x02, 0x40)};
    EXPECT_EQ(none.ask("68 05 05 68 88 02 5D 33 5E 78 16"), kSc) << "DSAP without SSAP";
    EXPECT_EQ(text(none.ram(none.list(), 3)), "33 02 40");
}

struct ServiceRow {
    std::uint8_t supported;
    bool sda_low, sda_high, srd_low, srd_high, sdn_low, sdn_high;
};

// Service_Supported 00..0B (reference 5.1); everything beyond permits nothing.
constexpr ServiceRow kServices[]{
    {0x00, true, true, true, true, true, true},       {0x01, false, false, false, false, true, false},
    {0x02, false, false, false, false, false, true},  {0x03, false, false, false, false, true, true},
    {0x04, false, false, true, true, true, true},     {0x05, true, false, false, false, false, false},
    {0x06, false, true, false, false, false, false},  {0x07, true, true, false, false, false, false},
    {0x08, false, false, false, false, false, false}, {0x09, false, false, true, false, false, false},
    {0x0A, false, false, false, true, false, false},  {0x0B, false, false, true, true, false, false},
    {0x0C, false, false, false, false, false, false}, {0x10, false, false, false, false, false, false},
};

// proves: VPC3C 7.2.1-20, VPC3C 7.2.1-21, VPC3C 7.2.1-32
TEST_P(ChecksStepBC, Service_Supported_permits_what_it_says) {
    for (const ServiceRow& row : kServices) {
        const struct { std::uint8_t fc; bool permitted, answered; } tries[]{
            {0x53, row.sda_low, true},  {0x55, row.sda_high, true}, {0x5C, row.srd_low, true},
            {0x5D, row.srd_high, true}, {0x44, row.sdn_low, false}, {0x46, row.sdn_high, false}};
        for (const auto& t : tries) {
            SapBench b{recipe(), SapBench::entry(0x33, 0x7F, 0x7F, row.supported)};
            const std::string answer = b.ask(b.request(2, t.fc, 0x33, {0x01, 0x02}));
            EXPECT_EQ(answer, !t.answered ? std::string{kSilence} : std::string{t.permitted ? kSc : kRs})
                << "service " << int{row.supported} << " FC " << int{t.fc};
            EXPECT_EQ(b.irr() != 0, t.permitted) << "service " << int{row.supported} << " FC " << int{t.fc};
            if (t.permitted) { EXPECT_EQ(b.peek(SapBench::kInd0 + 3), t.fc & 0x0F); }
        }
    }
}

TEST_P(ChecksStepBC, an_immediate_response_that_is_never_sent_still_lets_the_user_know_of_the_request) {
    SapBench b{recipe(), SapBench::entry(0x31)};
    b.respond({0x56, 0x30, 0x00, 0x64});
    b.tell(Stimulus{b.request(2, 0x5D, 0x31, {0x57}), {}, {}});
    b.run(b.bits(5));
    b.chip().carrier(b.now());
    EXPECT_EQ(b.irr(), irq::fdl_ind);
    EXPECT_EQ(b.peek(SapBench::kRespBuf), kUser | kResp) << "the response waits for the next poll";
}

// proves: VPC3C 7.2.1-01, VPC3C 7.2.1-09..11, VPC3C 7.2.1-15, VPC3C 4.1-11
TEST_P(ChecksStepBC, entries_of_seven_octets_for_SAPs_0_to_51_follow_each_other_up_to_FF) {
    Octets list;
    for (const std::uint8_t sap : {std::uint8_t{0}, std::uint8_t{25}, std::uint8_t{51}}) {
        const Octets one = SapBench::entry(sap);
        list.insert(list.end(), one.begin(), one.end());
    }
    SapBench b{recipe(), list};
    for (std::uint8_t sap = 0; sap <= 51; ++sap) {
        b.put(SapBench::kInd0, {0});
        const bool listed = sap == 0 || sap == 25 || sap == 51;
        EXPECT_EQ(b.ask(b.request(2, 0x5D, sap, {0x5E, 1})), listed ? kSc : kRs) << int{sap};
    }
}

// proves: VPC3C 7.2.1-12
TEST_P(ChecksStepBC, a_list_that_begins_with_FF_has_no_SAP) {
    SapBench b{recipe(), {}};
    for (std::uint8_t sap = 0; sap <= 51; ++sap) EXPECT_EQ(b.ask(b.request(2, 0x5D, sap, {0x5E, 1})), kRs) << int{sap};
    EXPECT_EQ(b.irr(), 0);
}

// proves: VPC3C 7.2.1-04, VPC3C 7.2.1-22, VPC3C 7.2.1-23, VPC3C 7.2.1-26..29, VPC3C 7.2.1-36
TEST_P(ChecksStepBC, a_buffer_with_any_of_its_control_bits_set_is_not_free) {
    for (const std::uint8_t bit : {std::uint8_t{0x80}, std::uint8_t{0x40}, std::uint8_t{0x20}, std::uint8_t{0x10}}) {
        SapBench b{recipe(), SapBench::entry(0x33)};
        b.write(SapBench::kInd0, bit);
        EXPECT_EQ(b.ask(kRead), kSc);
        EXPECT_EQ(b.peek(SapBench::kInd0), bit) << "untouched";
        EXPECT_EQ(text(b.ram(SapBench::kInd1, 4)), "C0 20 04 0D") << "the other one is taken";
        b.write(SapBench::kInd1, bit);
        b.put(static_cast<std::uint16_t>(b.list() + 1), {0x7F, 0x7F});
        EXPECT_EQ(b.ask(kRead), kRr);
    }
}

TEST_P(ChecksStepBC, a_list_without_an_end_ends_all_the_same) {
    SapBench b{recipe(), SapBench::entry(0x33)};
    for (std::uint16_t a = 0x40; a < 0x800; ++a)
        if (b.peek(a) == 0xFF) b.write(a, 0x00);
    EXPECT_EQ(b.ask(b.request(2, 0x5D, 0x20, {0x01})), kRs);
}

// proves: VPC3C 1-03
TEST_P(Checks, chips_without_DP_V1_answer_RS_on_every_listed_SAP) {
    if (traits().dpv1) return;  // the other tests of this file are about those
    Bench b{recipe(), Stage::p2};
    for (std::uint8_t sap = 0; sap <= 51; ++sap) EXPECT_EQ(b.ask(b.request(2, 0x5D, sap, {0x5E})), kRs) << int{sap};
}

}  // namespace
}  // namespace dpchip::checks
