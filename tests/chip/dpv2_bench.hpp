// SPDX-License-Identifier: Apache-2.0
// What the tests of chapter 7.3 add to the bench: a chip with DXB buffers, broadcasts of other stations, pin 13, and
// trace records as golden text.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include <dpchip/core/bits.hpp>
#include <dpchip/fdl/telegram.hpp>
#include <dpchip/trace/fact_text.hpp>

#include <support/golden.hpp>

#include "checks.hpp"

namespace dpchip::checks {

/// Segments of the DXB buffers in 2 KB mode, behind everything that the bench lays out: 256 octets per DXBout_Buf.
inline constexpr std::uint8_t kDxbOut1 = 0x50, kDxbOut2 = 0x70, kDxbOut3 = 0x90, kLinkBuf = 0xB0, kStatusBuf = 0xC0;
inline constexpr std::uint8_t kLongestDxbOut = 246;

/// An entry of DXB_Link_Buf (figure 7-8).
struct Link {
    std::uint8_t publisher{}, publisher_length{}, offset{}, length{};
};

/// Set_Prm of P1: watchdog 2 * 5 * 10 ms. The second one has DPV1_Enable and Publisher_Enable, minTSDR 39.
inline constexpr std::string_view kPrmPublisher = "68 0F 0F 68 88 82 5D 3D 3E 88 02 05 27 47 11 00 A0 00 00 90 16";
inline constexpr std::string_view kSynch = "68 07 07 68 FF 82 46 3A 3E 00 80 BF 16";

/// Sets a chip up that is still Offline: everything before Start that a test wants beside the recipe.
inline void write_dxb_cells(Bench& b) {
    b.write(org::r_len_dxbout_buf, kLongestDxbOut);
    b.write(org::r_dxbout_buf_ptr1, kDxbOut1);
    b.write(org::r_dxbout_buf_ptr2, kDxbOut2);
    b.write(org::r_dxbout_buf_ptr3, kDxbOut3);
    b.write(org::r_dxb_link_buf_ptr, kLinkBuf);
    b.write(org::r_dxb_status_buf_ptr, kStatusBuf);
}

/// What the firmware does with the links of a Set_Prm: both tables, then their lengths (7.3.1).
inline void write_links(Bench& b, const std::vector<Link>& links) {
    std::uint16_t link = kLinkBuf << 3, status = kStatusBuf << 3;
    for (const std::uint8_t octet : {static_cast<std::uint8_t>(4 + 2 * links.size()), std::uint8_t{0x83}, std::uint8_t{0}, std::uint8_t{0}})
        b.write(status++, octet);
    for (const Link& l : links) {
        for (const std::uint8_t octet : {l.publisher, l.publisher_length, l.offset, l.length}) b.write(link++, octet);
        b.write(status++, l.publisher);
        b.write(status++, 0x00);
    }
    b.write(org::r_len_dxb_link_buf, static_cast<std::uint8_t>(4 * links.size()));
    b.write(org::r_len_dxb_status_buf, static_cast<std::uint8_t>(4 + 2 * links.size()));
}

/// From a configured chip to P2 with `prm`.
inline void start_to_p2(Bench& b, std::string_view prm = kPrm) {
    b.start();
    b.find_baud();
    EXPECT_EQ(b.ask(prm), kSc);
    if (b.peek(org::r_len_prm_data) > 7) {
        EXPECT_EQ(b.read(control::user_prm_data_okay), regmap::acknowledge::finished);
    }
    EXPECT_EQ(b.ask(kCfg), kSc);
    EXPECT_EQ(b.read(control::user_cfg_data_okay), regmap::acknowledge::finished);
    b.give_inputs("AB CD");
    EXPECT_EQ(b.dp_state(), kDataExch);
    b.run(2_clk);
    b.acknowledge();
}

/// A subscriber in P2.
inline Bench subscriber(const Recipe& recipe, const std::vector<Link>& links, std::string_view prm = kPrm) {
    Bench b{recipe, Stage::configured};
    write_dxb_cells(b);
    write_links(b, links);
    start_to_p2(b, prm);
    return b;
}

/// A trace without its times, which depend on where the sampling grid lies when a bench speaks in bits.
inline std::string without_times(const std::string& trace) {
    constexpr std::string_view kUnit = " tBit  ";
    std::string out;
    for (std::size_t begin = 0; begin < trace.size();) {
        const std::size_t end = std::min(trace.find('\n', begin), trace.size() - 1) + 1;
        const std::string line = trace.substr(begin, end - begin);
        const std::size_t unit = line.find(kUnit);
        out += unit == std::string::npos ? line : line.substr(unit + kUnit.size());
        begin = end;
    }
    return out;
}

inline testing::AssertionResult matches_golden(Path path, std::string_view name, const std::string& trace) {
    if (path != Path::bits) return test::matches_golden(name, trace);
    const std::string golden = test::read_file(std::filesystem::path(DPCHIP_SOURCE_DIR) / "tests" / "golden" / name);
    if (!golden.empty() && without_times(golden) == without_times(trace)) return testing::AssertionSuccess();
    return testing::AssertionFailure() << name << " differs in more than its times:\n" << trace;
}

/// Any SD2 telegram.
inline Octets telegram(std::uint8_t da, std::uint8_t sa, std::uint8_t fc, const Octets& unit) {
    Octets out(fdl::kMaxTelegram);
    out.resize(fdl::encode(out, da, sa, fc, unit));
    return out;
}

/// The answer of a publisher to everybody.
inline void publish(Bench& b, std::uint8_t publisher, const Octets& data, std::uint8_t fc = 0x08) {
    b.tell(Stimulus{telegram(0x7F, publisher, fc, data), {}, {}});
    b.run(2_clk);
}

inline void tell(Bench& b, std::string_view octets) {
    b.tell(octets);
    b.run(2_clk);
}

/// Trace records from now on as golden text: headings by the test, facts by the chip, time counted from here.
class Recording {
public:
    explicit Recording(Bench& b) : b_{b}, ring_(1u << 14), from_{b.now()}, facts_{b.recipe().variant} {
        b_.chip().trace().attach(ring_);
        // What was written and found before the recording began.
        const auto before = [&](regmap::Fact fact, std::uint16_t a, std::uint32_t value) {
            static_cast<void>(facts_.line({{}, static_cast<std::uint16_t>(fact), a, value}));
        };
        before(regmap::Fact::baud, 0, static_cast<std::uint32_t>(b.recipe().baud));
        before(regmap::Fact::cpu_write, control::mode_reg0_low, core::low(b.recipe().mode0));
    }
    Recording(const Recording&) = delete;
    Recording& operator=(const Recording&) = delete;
    ~Recording() { b_.chip().trace().attach({}); }

    void heading(std::string_view words) {
        flush();
        text_ += "# " + std::string{words} + '\n';
    }
    std::string text() {
        flush();
        return text_;
    }

private:
    void flush() {
        for (; seen_ < b_.chip().trace().count; ++seen_) {
            core::TraceRecord record = ring_.at(seen_);
            record.at = record.at - from_;
            text_ += facts_.line(record) + '\n';
        }
    }

    Bench& b_;
    std::vector<core::TraceRecord> ring_;
    Ticks from_;
    trace::FactText facts_;
    std::uint64_t seen_{};
    std::string text_;
};

/// Edges of pin 13 since the last call.
inline std::vector<chip::Edge> sync_edges(Bench& b) {
    std::vector<chip::Edge> out;
    while (!b.chip().edges().empty()) {
        const chip::Edge edge = b.chip().edges().pop();
        if (edge.pin == chip::Pin::xdataexch_sync) out.push_back(edge);
    }
    return out;
}

}  // namespace dpchip::checks
