// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <dpchip/live/line_error.hpp>
#include <dpchip/live/tty.hpp>
#include <dpchip/live/uart_stream.hpp>
#include <dpchip/live/uri.hpp>

namespace dpchip::live {
namespace {

struct Read { const char* text; Role role; Scheme scheme; const char* path; const char* host; int port; };

class UriReads : public testing::TestWithParam<Read> {};

TEST_P(UriReads, AsItsParts) {
    const Uri uri = parse_uri(GetParam().text, GetParam().role);
    EXPECT_EQ(uri.scheme, GetParam().scheme);
    EXPECT_EQ(uri.path, GetParam().path);
    EXPECT_EQ(uri.host, GetParam().host);
    EXPECT_EQ(uri.port, GetParam().port);
}

INSTANTIATE_TEST_SUITE_P(Each, UriReads, testing::Values(
    Read{"pty", Role::serve, Scheme::pty, "", "", 0}, Read{"pty:/run/dp0", Role::serve, Scheme::pty, "/run/dp0", "", 0},
    Read{"pty:/run/dp0", Role::visit, Scheme::tty, "/run/dp0", "", 0}, Read{"/dev/pts/3", Role::visit, Scheme::tty, "/dev/pts/3", "", 0},
    Read{"serial:/dev/ttyUSB0", Role::serve, Scheme::serial, "/dev/ttyUSB0", "", 0},
    Read{"serial:/dev/ttyUSB0", Role::visit, Scheme::serial, "/dev/ttyUSB0", "", 0},
    Read{"tty:/dev/pts/3", Role::serve, Scheme::tty, "/dev/pts/3", "", 0},
    Read{"tcp:127.0.0.1:9000", Role::serve, Scheme::tcp_listen, "", "127.0.0.1", 9000},
    Read{"tcp:9000", Role::serve, Scheme::tcp_listen, "", "127.0.0.1", 9000}, Read{"tcp::9000", Role::serve, Scheme::tcp_listen, "", "127.0.0.1", 9000},
    Read{"tcp:0.0.0.0:0", Role::serve, Scheme::tcp_listen, "", "0.0.0.0", 0}, Read{"tcp:[::1]:9000", Role::serve, Scheme::tcp_listen, "", "::1", 9000},
    Read{"tcp:plc:9000", Role::visit, Scheme::tcp_connect, "", "plc", 9000},
    Read{"tcp+connect:plc:9000", Role::serve, Scheme::tcp_connect, "", "plc", 9000}));

class UriIsMalformed : public testing::TestWithParam<const char*> {};

TEST_P(UriIsMalformed, AndSaysSo) {
    try {
        static_cast<void>(parse_uri(GetParam()));
        FAIL() << GetParam();
    } catch (const LineError& error) {
        EXPECT_EQ(error.kind(), LineErrorKind::malformed);
        EXPECT_NE(std::string{error.what()}.find(GetParam()), std::string::npos) << error.what();
    }
}

INSTANTIATE_TEST_SUITE_P(Each, UriIsMalformed, testing::Values("", "pty:", "serial", "serial:", "tcp", "tcp:", "tcp:host", "tcp:host:", "tcp:host:70000",
    "tcp:host:-1", "tcp:host:9000x", "tcp:::1:9000", "tcp:[::1:9000", "tcp:[::1]", "tcp+connect:host:0", "udp:host:1", "/dev/ttyS0", "sim:"));

TEST(ParityMarks, AreUndoneOverAnyBoundary) {
    ParityMarks marks;
    std::vector<std::pair<int, int>> seen;
    for (const int raw : {0x10, 0xFF, 0xFF, 0xFF, 0x00, 0x42, 0xFF, 0x00, 0xFF, 0xFF, 0x00, 0x00, 0xFF, 0x31})
        marks.feed(static_cast<std::uint8_t>(raw), [&](std::uint8_t octet, std::uint8_t faults) { seen.emplace_back(octet, faults); });
    const std::vector<std::pair<int, int>> expected{{0x10, 0}, {0xFF, 0}, {0x42, 1}, {0xFF, 1}, {0x00, 1}, {0xFF, 0}, {0x31, 0}};
    EXPECT_EQ(seen, expected);
}

TEST(EchoFilter, DropsWhatWasSentAndNothingElse) {
    using namespace core::literals;
    EchoFilter echo;
    const std::uint8_t sent[]{0x10, 0x02};
    EXPECT_FALSE(echo.drops(0x10, 1_ms));
    echo.sent(sent, 10_ms);
    EXPECT_TRUE(echo.drops(0x10, 2_ms));
    EXPECT_TRUE(echo.drops(0x02, 2_ms));
    EXPECT_FALSE(echo.drops(0x10, 2_ms)) << "the echo is over";
    echo.sent(sent, 10_ms);
    EXPECT_FALSE(echo.drops(0xE5, 2_ms)) << "not the echo";
    EXPECT_FALSE(echo.drops(0x10, 2_ms)) << "nor is what follows";
    echo.sent(sent, 10_ms);
    EXPECT_FALSE(echo.drops(0x10, 11_ms)) << "too late to be one";
}

TEST(Rates, AreRefusedMoreThanTwoPercentOff) {
    EXPECT_TRUE(rate_close(19200, 19200));
    EXPECT_TRUE(rate_close(45454, 45454));
    EXPECT_TRUE(rate_close(102, 100));
    EXPECT_TRUE(rate_close(98, 100));
    EXPECT_FALSE(rate_close(103, 100));
    EXPECT_FALSE(rate_close(97, 100));
    EXPECT_FALSE(rate_close(0, 12'000'000));
}

}  // namespace
}  // namespace dpchip::live
