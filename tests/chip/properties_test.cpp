// SPDX-License-Identifier: Apache-2.0
// Properties that hold whatever happens: random work of masters and processor, replayed in ways that must not matter.
#include "checks.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <memory>
#include <random>
#include <utility>
#include <vector>

namespace dpchip::checks {
namespace {

using ChipUnderTest = Bench::ChipUnderTest;

/// One thing that a master or the processor does.
struct Deed {
    enum class Kind : std::uint8_t { ask, repeat, damaged, read, write, inputs, diag, run } kind{};
    Octets octets{};
    std::uint16_t address{};
    std::uint8_t value{};
    std::int64_t ticks{};
};

constexpr std::array<std::string_view, 28> kTelegrams{kFdlStatus,
                                                      kPrm,
                                                      kPrm,
                                                      kPrm10,
                                                      kPrm10,
                                                      kCfg,
                                                      kCfg,
                                                      kCfg,
                                                      kDx1234,
                                                      kDx5678,
                                                      kDx1234,
                                                      kDx5678,
                                                      "68 0D 0D 68 88 82 5D 3D 3E 88 02 05 0B 47 11 00 04 D8 16",
                                                      "68 0C 0C 68 88 82 5D 3D 3E 80 01 01 0B 47 11 00 C7 16",
                                                      "68 0C 0C 68 88 82 5D 3D 3E 40 01 01 00 47 11 00 7C 16",
                                                      "68 0C 0C 68 88 83 6D 3D 3E 88 02 05 0B 47 11 00 E5 16",
                                                      "68 05 05 68 88 82 5D 3C 3E E1 16",
                                                      "68 05 05 68 88 83 6D 3C 3E F2 16",
                                                      "68 05 05 68 08 03 7D 12 34 CE 16",
                                                      "68 05 05 68 88 82 5D 38 3E DD 16",
                                                      "68 05 05 68 88 82 5D 39 3E DE 16",
                                                      "68 05 05 68 88 82 5D 3B 3E E0 16",
                                                      "68 07 07 68 FF 82 46 3A 3E 20 00 5F 16",
                                                      "68 07 07 68 FF 82 46 3A 3E 30 00 6F 16",
                                                      "68 07 07 68 FF 82 46 3A 3E 02 00 41 16",
                                                      "68 07 07 68 FF 82 46 3A 3E 08 00 47 16",
                                                      "68 07 07 68 FF 82 46 3A 3E 04 00 43 16",
                                                      "10 08 02 7D 87 16"};

using Random = std::mt19937_64;
std::size_t below(Random& random, std::size_t n) {
    return std::uniform_int_distribution<std::size_t>{0, n - 1}(random);
}
std::uint8_t octet(Random& random) { return static_cast<std::uint8_t>(below(random, 256)); }

Deed access(Random& random) {
    static constexpr std::array<std::uint16_t, 14> kReads{0x09, 0x0B, 0x0B, 0x0D, 0x0E, 0x0E, 0x0E,
                                                          0x0F, 0x10, 0x10, 0x10, 0x11, 0x13, 0x14};
    static constexpr std::array<std::uint8_t, 8> kMode1{0x01, 0x01, 0x02, 0x02, 0x10, 0x20, 0x08, 0x04};
    switch (below(random, 8)) {
    case 0: return {Deed::Kind::write, {}, control::mode_reg1_s, kMode1[below(random, kMode1.size())], 0};
    case 1:
        return {Deed::Kind::write,
                {},
                static_cast<std::uint16_t>(control::int_ack_reg_low + below(random, 2)),
                octet(random),
                0};
    case 2:
        return {Deed::Kind::write,
                {},
                static_cast<std::uint16_t>(control::int_mask_reg_low + below(random, 2)),
                octet(random),
                0};
    case 3: return {Deed::Kind::inputs, {octet(random), octet(random)}, 0, 0, 0};
    case 4: return {Deed::Kind::diag, {}, 0, static_cast<std::uint8_t>(below(random, 8)), 0};
    default: return {Deed::Kind::read, {}, kReads[below(random, kReads.size())], 0, 0};
    }
}

Deed random_deed(Random& random) {
    const std::size_t dice = below(random, 100);
    if (dice < 45) return {Deed::Kind::ask, hex(kTelegrams[below(random, kTelegrams.size())]), 0, 0, 0};
    if (dice < 50) return {Deed::Kind::repeat, {}, 0, 0, 0};
    if (dice < 55) {
        Octets octets = hex(kTelegrams[below(random, kTelegrams.size())]);
        octets[below(random, octets.size())] ^= static_cast<std::uint8_t>(1u << below(random, 8));
        return {Deed::Kind::damaged, octets, 0, 0, 0};
    }
    if (dice < 93) return access(random);
    return {
        Deed::Kind::run,
        {},
        0,
        0,
        static_cast<std::int64_t>(below(random, dice == 99 /* up to 100 ms, else 10 us */ ? std::size_t{6'000'000'000}
                                                                                          : std::size_t{600'000}))};
}

std::vector<Deed> random_deeds(std::uint64_t seed, std::size_t count) {
    Random random{seed};
    std::vector<Deed> deeds(count);
    std::generate(deeds.begin(), deeds.end(), [&] { return random_deed(random); });
    return deeds;
}

/// Inputs and diagnosis as firmware gives them, whatever state the buffers are in.
std::uint8_t give(Bench& b, const Deed& deed) {
    if (deed.kind == Deed::Kind::inputs) return b.give_inputs(text(deed.octets));
    const std::uint8_t sm = b.peek(control::diag_buffer_sm);
    if ((sm & 3u) != regmap::diag_owner::user && (sm >> 2) != regmap::diag_owner::user) return 0xFF;
    return b.give_diag(deed.value, "04 AA 55 33");
}

/// Does a deed; returns what could be observed.
std::string perform(Bench& b, const Deed& deed) {
    switch (deed.kind) {
    case Deed::Kind::ask: return b.ask(deed.octets);
    case Deed::Kind::repeat: return b.ask_again();
    case Deed::Kind::damaged: return b.ask_verbatim(text(deed.octets));
    case Deed::Kind::read: return text(Octets{b.read(deed.address)});
    case Deed::Kind::write: b.write(deed.address, deed.value); return {};
    case Deed::Kind::inputs:
    case Deed::Kind::diag: return text(Octets{give(b, deed)});
    case Deed::Kind::run: b.run({deed.ticks}); return {};
    }
    return {};
}

constexpr std::size_t kDeeds = 400;
constexpr std::array<std::uint64_t, 3> kSeeds{1, 2026, 0xDEADBEEF};

std::string trace_of(std::uint64_t seed, std::size_t i, const Deed& deed) {
    return "seed " + std::to_string(seed) + ", deed " + std::to_string(i) + " kind " +
           std::to_string(static_cast<int>(deed.kind)) + " address " + std::to_string(deed.address) + " value " +
           std::to_string(deed.value) + " octets " + text(deed.octets);
}

bool same_state(const ChipUnderTest& a, const ChipUnderTest& b) {
    return std::memcmp(&a.state(), &b.state(), sizeof(chip::State)) == 0;
}

// ---- buffers
// ------------------------------------------------------------------------------------------------------------

/// F, U, N, D: U and D name buffers, one of F and N is Nil, no buffer is named twice (reference 4.5).
bool is_three_buffer_state(std::uint8_t sm) {
    const unsigned f = sm >> 6, u = (sm >> 4) & 3u, n = (sm >> 2) & 3u, d = sm & 3u;
    if ((f == 0) == (n == 0)) return false;
    const unsigned third = f + n;
    return u != 0 && d != 0 && u != d && u != third && d != third;
}

/// One buffer is the user's, or an exchange waits for the end of a Slave_Diag answer (reference 4.6).
bool is_diag_state(std::uint8_t sm) {
    static constexpr std::array<std::uint8_t, 6> kStates{0x09, 0x06, 0x0D, 0x07, 0x0E, 0x0B};
    return std::find(kStates.begin(), kStates.end(), sm) != kStates.end();
}

/// The segments that the exchanges move around; their set never changes.
std::array<std::uint8_t, 5> exchanged_segments(const Bench& b) {
    std::array<std::uint8_t, 5> s{b.peek(org::r_aux_buf_ptr1), b.peek(org::r_ssa_buf_ptr), b.peek(org::r_prm_buf_ptr),
                                  b.peek(org::r_cfg_buf_ptr), b.peek(org::r_read_cfg_buf_ptr)};
    std::sort(s.begin(), s.end());
    return s;
}

TEST_P(Checks, buffer_machines_stay_valid_whatever_happens) {
    for (const std::uint64_t seed : kSeeds) {
        const std::vector<Deed> deeds = random_deeds(seed, kDeeds);
        Recipe r = recipe();
        r.ssa = true;
        Bench b{r, Stage::p0};
        const auto segments = exchanged_segments(b);
        b.set_meddler([](ChipUnderTest& chip) {
            ASSERT_TRUE(is_three_buffer_state(chip.peek(control::din_buffer_sm)));
            ASSERT_TRUE(is_three_buffer_state(chip.peek(control::dout_buffer_sm)));
            ASSERT_TRUE(is_diag_state(chip.peek(control::diag_buffer_sm)));
        });
        for (std::size_t i = 0; i < deeds.size(); ++i) {
            SCOPED_TRACE(trace_of(seed, i, deeds[i]));
            perform(b, deeds[i]);
            ASSERT_TRUE(is_three_buffer_state(b.peek(control::din_buffer_sm)));
            ASSERT_TRUE(is_three_buffer_state(b.peek(control::dout_buffer_sm)));
            ASSERT_TRUE(is_diag_state(b.peek(control::diag_buffer_sm))) << int{b.peek(control::diag_buffer_sm)};
            ASSERT_EQ(exchanged_segments(b), segments);
            ASSERT_FALSE(HasFailure());
        }
    }
}

TEST_P(Checks, the_user_always_gets_the_last_outputs) {
    Random random{7};
    Bench b{recipe(), Stage::p2};
    b.take_outputs();
    Octets last;
    for (int i = 0; i < 300; ++i) {
        last = {octet(random), octet(random)};
        ASSERT_EQ(b.ask(b.request(2, 0x5D, std::nullopt, last)), kInputs);
        if (below(random, 3) != 0) continue;
        const Outputs out = b.take_outputs();
        ASSERT_EQ(out.command & 0x0C, 0x04);
        ASSERT_EQ(out.octets, last);
    }
}

// ---- time and snapshots
// -----------------------------------------------------------------------------------------------

/// Plays the same deeds on two benches and compares what can be observed and every octet of state.
void expect_same(std::uint64_t seed, Bench& a, Bench& b) {
    const std::vector<Deed> deeds = random_deeds(seed, kDeeds);
    for (std::size_t i = 0; i < deeds.size(); ++i) {
        SCOPED_TRACE(trace_of(seed, i, deeds[i]));
        ASSERT_EQ(perform(a, deeds[i]), perform(b, deeds[i]));
        ASSERT_EQ(a.last_answer().start, b.last_answer().start);
        ASSERT_TRUE(same_state(a.chip(), b.chip()));
    }
}

TEST_P(Checks, it_does_not_matter_in_how_many_steps_time_advances) {
    for (const std::uint64_t seed : kSeeds) {
        Bench a{recipe(), Stage::p0}, b{recipe(), Stage::p0};
        b.set_chunk(97_us);
        expect_same(seed, a, b);
    }
}

TEST_P(Checks, one_leap_over_many_events_equals_stepping_from_event_to_event) {
    Bench a{recipe(), Stage::p2}, b{recipe(), Stage::p2};
    const Ticks end = a.now() + 11_s;  // APC3 keeps a found rate for 9 s
    a.run_to(end);
    b.chip().advance(end);
    EXPECT_TRUE(same_state(a.chip(), b.chip()));
    EXPECT_EQ(a.wd_state(), kBaudSearch);
}

void replace_by_snapshot(ChipUnderTest& chip, const Recipe& r) {
    std::vector<std::uint8_t> snapshot(ChipUnderTest::snapshot_size());
    const auto size = chip.save(snapshot);
    ASSERT_TRUE(size);
    ASSERT_LE(*size, snapshot.size());
    ChipUnderTest fresh{r.variant, r.options, r.bus_mode};
    ASSERT_EQ(fresh.load(std::span{snapshot}.first(*size)), core::ArchiveError::none);
    ASSERT_TRUE(same_state(chip, fresh));
    chip = fresh;
}

TEST_P(Checks, a_snapshot_taken_at_any_moment_goes_on_as_if_nothing_had_happened) {
    for (const std::uint64_t seed : kSeeds) {
        const Recipe r = recipe();
        Bench a{r, Stage::p0}, b{r, Stage::p0};
        Random random{seed ^ 0x5A5A};
        b.set_meddler([&](ChipUnderTest& chip) {
            if (below(random, 20) == 0) replace_by_snapshot(chip, r);
        });
        expect_same(seed, a, b);
    }
}

TEST_P(Checks, a_damaged_snapshot_is_refused_and_leaves_the_chip_alone) {
    Bench b{recipe(), Stage::p2};
    std::vector<std::uint8_t> snapshot(ChipUnderTest::snapshot_size());
    const auto size = b.chip().save(snapshot);
    ASSERT_TRUE(size);
    snapshot.resize(*size);
    const ChipUnderTest before = b.chip();
    Random random{11};
    for (int i = 0; i < 200; ++i) {
        std::vector<std::uint8_t> bad = snapshot;
        bad[below(random, bad.size())] ^= static_cast<std::uint8_t>(1u << below(random, 8));
        EXPECT_NE(b.chip().load(bad), core::ArchiveError::none);
        bad = snapshot;
        bad.resize(below(random, bad.size()));
        EXPECT_NE(b.chip().load(bad), core::ArchiveError::none);
        ASSERT_TRUE(same_state(before, b.chip()));
    }
}

TEST_P(Checks, a_snapshot_of_another_variant_is_refused) {
    Bench b{recipe(), Stage::p0};
    std::vector<std::uint8_t> snapshot(ChipUnderTest::snapshot_size());
    const auto size = b.chip().save(snapshot);
    ASSERT_TRUE(size);
    ChipUnderTest other{GetParam().variant == Variant::vpc3c ? Variant::apc3 : Variant::vpc3c};
    EXPECT_EQ(other.load(std::span{snapshot}.first(*size)), core::ArchiveError::variant);
}

// ---- peek, and the two ways to hear
// ------------------------------------------------------------------------------------

TEST_P(Checks, peek_shows_what_read_would_return_and_changes_nothing) {
    for (const std::uint64_t seed : kSeeds) {
        Bench b{recipe(), Stage::p2};
        const std::vector<Deed> deeds = random_deeds(seed, 40);
        for (const Deed& deed : deeds) {
            perform(b, deed);
            const ChipUnderTest before = b.chip();
            for (unsigned a = 0; a < 0x1000; ++a) {
                const auto address = static_cast<std::uint16_t>(a);
                const std::uint8_t peeked = b.chip().peek(address);
                if (a >= 0x16 && (a & 0x3F) != 0 && a < b.traits().ram_bytes) continue;  // plain RAM: a sample will do
                ChipUnderTest copy = b.chip();
                ASSERT_EQ(copy.read(address), peeked) << "address " << a;
            }
            for (unsigned a = 0x1000; a <= 0xFFFF; a += 0x100) b.chip().peek(static_cast<std::uint16_t>(a));
            ASSERT_TRUE(same_state(before, b.chip()));
        }
    }
}

TEST_P(Checks, whole_telegrams_single_characters_and_bits_have_the_same_effects) {
    Recipe characters = recipe(), telegrams = recipe(), bits = recipe();
    characters.path = Path::characters;
    telegrams.path = Path::telegrams;
    bits.path = Path::bits;
    for (const std::uint64_t seed : kSeeds) {
        Bench a{telegrams, Stage::p0}, b{characters, Stage::p0}, c{bits, Stage::p0};
        const std::vector<Deed> deeds = random_deeds(seed, kDeeds);
        for (std::size_t i = 0; i < deeds.size(); ++i) {
            SCOPED_TRACE(trace_of(seed, i, deeds[i]));
            const bool damaged = deeds[i].kind == Deed::Kind::damaged;
            if (damaged) {  // a damaged telegram always comes in characters
                a.tell({deeds[i].octets, {{0, fdl::fault_parity}}, {}});
                b.tell({deeds[i].octets, {{0, fdl::fault_parity}}, {}});
                c.tell({deeds[i].octets, {{0, fdl::fault_parity}}, {}});
                const std::string answer = a.listen_text();
                ASSERT_EQ(answer, b.listen_text());
                ASSERT_EQ(answer, c.listen_text());
            } else {
                const auto done = perform(a, deeds[i]);
                ASSERT_EQ(done, perform(b, deeds[i]));
                ASSERT_EQ(done, perform(c, deeds[i]));
            }
            ASSERT_EQ(a.now(), b.now());
            ASSERT_EQ(a.last_answer().start, b.last_answer().start);
            if (c.last_answer().start > c.request_end()) {  // later by where the grid lies, never by more than it takes
                ASSERT_EQ(a.last_answer().start - a.request_end(), c.last_answer().start - c.request_end());
            }
            ASSERT_EQ(a.ram(0, a.traits().ram_bytes), b.ram(0, b.traits().ram_bytes));
            const Octets all = a.ram(org::first, a.traits().ram_bytes - org::first);
            ASSERT_EQ(all, c.ram(org::first, c.traits().ram_bytes - org::first));
        }
    }
}

}  // namespace
}  // namespace dpchip::checks
