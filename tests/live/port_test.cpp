// SPDX-License-Identifier: Apache-2.0
// Real ptys and sockets of the loopback. Waits are limits, not expectations: a slow machine only takes longer.
#include <arpa/inet.h>
#include <fcntl.h>
#include <netinet/in.h>
#include <stdlib.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/time.h>
#include <termios.h>

#include <cerrno>
#include <csignal>
#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>

#include <dpchip/live/device_port.hpp>
#include <dpchip/live/open_line.hpp>
#include <dpchip/live/pty_port.hpp>
#include <dpchip/live/tcp_port.hpp>
#include <dpchip/live/tty.hpp>

#include "fakes.hpp"

namespace dpchip::live {
namespace {

constexpr Ticks kLimit = 20_s;
const Octets kStatus8 = octets("10 08 02 49 53 16");

LineErrorKind refused(const std::string& uri, Role role = Role::serve) {
    try {
        static_cast<void>(open_port(parse_uri(uri, role), fdl::BaudCode::kbit_19_2));
    } catch (const LineError& error) {
        EXPECT_NE(std::string{error.what()}.find(uri.substr(uri.find(':') + 1)), std::string::npos) << error.what();
        return error.kind();
    }
    ADD_FAILURE() << uri << " was opened";
    return LineErrorKind::system;
}

/// A folder of its own, gone at the end.
struct Folder {
    Folder() {
        std::string name = (std::filesystem::temp_directory_path() / "dpchip-XXXXXX").string();
        path = ::mkdtemp(name.data());
    }
    ~Folder() { std::filesystem::remove_all(path); }
    Folder(const Folder&) = delete;
    Folder& operator=(const Folder&) = delete;
    std::string file(const char* name) const { return path + "/" + name; }
    std::string path;
};

/// What a master program does with a serial port: open, 8E1 at 19200, through the C library.
Descriptor open_as_master(const std::string& path, int& result) {
    Descriptor fd{::open(path.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK)};
    termios t{};
    result = ::tcgetattr(fd.get(), &t);
    ::cfmakeraw(&t);
    t.c_cflag |= PARENB | CLOCAL | CREAD;
    t.c_cflag &= ~static_cast<tcflag_t>(PARODD | CSTOPB);
    ::cfsetispeed(&t, B19200);
    ::cfsetospeed(&t, B19200);
    if (result == 0) result = ::tcsetattr(fd.get(), TCSANOW, &t);
    return fd;
}

/// Writes a request to `fd`, lives until `count` octets have come back, and returns them.
Octets exchange(LiveLine& line, int fd, const Octets& request, std::size_t count) {
    EXPECT_EQ(::write(fd, request.data(), request.size()), static_cast<ssize_t>(request.size()));
    Octets answer;
    line.run(kLimit, [&] {
        std::array<std::uint8_t, 256> buffer{};
        const ssize_t got = ::read(fd, buffer.data(), buffer.size());
        if (got > 0) answer.insert(answer.end(), buffer.begin(), buffer.begin() + got);
        return answer.size() >= count;
    });
    return answer;
}

TEST(Pty, MastersComeAndGoWithEvenParity) {
    OpenLine open{"pty", Role::serve};
    Echoer slave;
    ASSERT_TRUE(open.line().segment().attach(slave));
    for (int i = 0; i < 3; ++i) {
        int result = -1;
        const Descriptor master = open_as_master(open.port().place(), result);
        EXPECT_EQ(result, 0) << "master " << i << ": " << errno;
        EXPECT_EQ(exchange(open.line(), master.get(), kStatus8, 1), Octets{0xE5});
    }
}

TEST(Pty, SetsItsTtyEndBackToB50WhenOctetsArriveAtAnotherRate) {
    PtyPort port{""};
    int result = -1;
    const Descriptor master = open_as_master(port.tty_path(), result);
    EXPECT_TRUE(pty_disturbed(master.get()));
    const std::uint8_t octet = 0xFF;
    ASSERT_EQ(::write(master.get(), &octet, 1), 1);
    Reception r;
    while (!port.receive(r)) port.wait(kLimit);
    EXPECT_EQ(r.size, 1u);
    EXPECT_EQ(r.octets[0], 0xFF);
    EXPECT_FALSE(pty_disturbed(master.get()));
}

TEST(Pty, CarriesAllOctetsUnchangedBothWays) {
    PtyPort port{""};
    int result = -1;
    const Descriptor master = open_as_master(port.tty_path(), result);
    Octets all(255);
    for (std::size_t i = 0; i < all.size(); ++i) all[i] = static_cast<std::uint8_t>(i);
    ASSERT_EQ(::write(master.get(), all.data(), all.size()), 255);
    Octets up, down;
    Reception r;
    while (up.size() < all.size()) {
        port.wait(kLimit);
        if (port.receive(r)) up.insert(up.end(), r.octets.begin(), r.octets.begin() + static_cast<long>(r.size));
    }
    EXPECT_EQ(up, all);
    ASSERT_TRUE(port.send(all));
    pollfd wait{master.get(), POLLIN, 0};
    while (down.size() < all.size() && ::poll(&wait, 1, 20'000) == 1) {
        std::array<std::uint8_t, 256> buffer{};
        const ssize_t got = ::read(master.get(), buffer.data(), buffer.size());
        if (got > 0) down.insert(down.end(), buffer.begin(), buffer.begin() + got);
    }
    EXPECT_EQ(down, all);
}

TEST(Pty, MakesItsLinkAndTakesItAway) {
    const Folder folder;
    const std::string link = folder.file("dp0");
    {
        PtyPort port{link};
        EXPECT_EQ(port.place(), link);
        EXPECT_EQ(std::filesystem::read_symlink(link), port.tty_path());
        EXPECT_EQ(refused("pty:" + link), LineErrorKind::busy) << "another program serves it";
        EXPECT_EQ(std::filesystem::read_symlink(link), port.tty_path());
    }
    EXPECT_FALSE(std::filesystem::is_symlink(link));
}

TEST(Pty, ReplacesADeadLinkButNoFile) {
    const Folder folder;
    std::filesystem::create_symlink("/dev/pts/no-such-pty", folder.file("dead"));
    { PtyPort port{folder.file("dead")}; EXPECT_EQ(std::filesystem::read_symlink(folder.file("dead")), port.tty_path()); }
    std::ofstream{folder.file("file")} << "precious";
    EXPECT_EQ(refused("pty:" + folder.file("file")), LineErrorKind::busy);
    EXPECT_EQ(std::filesystem::file_size(folder.file("file")), 8u);
    EXPECT_EQ(refused("pty:" + folder.file("no/such/folder")), LineErrorKind::missing);
}

TEST(Pty, LeavesALinkAloneThatPointsElsewhereMeanwhile) {
    const Folder folder;
    const std::string link = folder.file("dp0");
    {
        PtyPort port{link};
        std::filesystem::remove(link);
        std::filesystem::create_symlink("/dev/null", link);
    }
    EXPECT_TRUE(std::filesystem::is_symlink(link));
}

TEST(Pty, DropsAnAnswerThatNobodyReadsInsteadOfWaiting) {
    PtyPort port{""};
    const Octets answer(255, 0x68);
    int taken = 0;
    while (taken < 1000 && port.send(answer)) ++taken;
    EXPECT_LT(taken, 1000);
}

TEST(Visitor, ReachesAPtyByItsLinkAsAMasterDoes) {
    const Folder folder;
    OpenLine served{"pty:" + folder.file("dp0"), Role::serve};
    Echoer slave, master;
    slave.answer = octets("10 02 08 00 0A 16");
    ASSERT_TRUE(served.line().segment().attach(slave));
    OpenLine visit{"pty:" + folder.file("dp0"), Role::visit};
    EXPECT_EQ(visit.port().medium(), Medium::pty);
    master.ts = 2;
    master.answer = kStatus8;
    ASSERT_TRUE(visit.line().segment().attach(master));
    master.due = 0_ns;
    visit.line().segment().touch(1);
    for (int i = 0; i < 2000 && master.heard.empty(); ++i) {
        visit.line().run(1_ms);
        served.line().run(1_ms);
    }
    ASSERT_FALSE(master.heard.empty());
    EXPECT_EQ(master.heard[0], slave.answer);
    EXPECT_EQ(slave.heard.at(0), kStatus8);
}

TEST(Visitor, IsToldWhenThePtyIsGone) {
    auto served = std::make_unique<PtyPort>("");
    DevicePort visitor{served->tty_path(), fdl::BaudCode::kbit_19_2, DevicePort::Accept::pty_too};
    served.reset();
    Reception r;
    try {
        for (int i = 0; i < 10; ++i) {
            visitor.wait(1_s);
            visitor.receive(r);
        }
        FAIL();
    } catch (const LineError& error) { EXPECT_EQ(error.kind(), LineErrorKind::gone) << error.what(); }
}

TEST(Device, SaysWhyItCannotBeOpened) {
    const Folder folder;
    std::ofstream{folder.file("file")} << "x";
    EXPECT_EQ(refused("serial:" + folder.file("none")), LineErrorKind::missing);
    EXPECT_EQ(refused("serial:" + folder.file("file")), LineErrorKind::unsuitable);
    EXPECT_EQ(refused("serial:" + folder.path), LineErrorKind::unsuitable);
    EXPECT_EQ(refused("pty:" + folder.file("none"), Role::visit), LineErrorKind::missing);
    const PtyPort served{""};
    EXPECT_EQ(refused("serial:" + served.tty_path()), LineErrorKind::busy) << "locked by its server";
    if (::geteuid() == 0) {
        std::puts("left out: a device without permission, because this runs as root");
        return;
    }
    ::chmod(folder.file("file").c_str(), 0);
    EXPECT_EQ(refused("serial:" + folder.file("file")), LineErrorKind::permission);
}

TEST(Device, RefusesATerminalWithoutEvenParity) {
    const Descriptor pty{::posix_openpt(O_RDWR | O_NOCTTY)};
    ASSERT_EQ(::grantpt(pty.get()) | ::unlockpt(pty.get()), 0);
    std::array<char, 128> path{};
    ASSERT_EQ(::ptsname_r(pty.get(), path.data(), path.size()), 0);
    EXPECT_EQ(refused(std::string{"serial:"} + path.data()), LineErrorKind::unsuitable);
    const Descriptor tty{::open(path.data(), O_RDWR | O_NOCTTY)};
    for (std::size_t i = 0; i < fdl::kBaudRates; ++i) {
        try {
            set_uart(tty.get(), path.data(), static_cast<fdl::BaudCode>(i));
            FAIL() << "a pty has no parity";
        } catch (const LineError& error) { EXPECT_EQ(error.kind(), LineErrorKind::unsuitable) << error.what(); }
    }
    EXPECT_FALSE(enable_rs485(tty.get()));
}

TEST(Errors, HaveAKind) {
    const std::pair<int, LineErrorKind> rows[]{{ENOENT, LineErrorKind::missing}, {EACCES, LineErrorKind::permission}, {EBUSY, LineErrorKind::busy},
        {EADDRINUSE, LineErrorKind::busy}, {ECONNREFUSED, LineErrorKind::missing}, {EIO, LineErrorKind::gone}, {ENOTTY, LineErrorKind::unsuitable},
        {ENOMEM, LineErrorKind::system}};
    for (const auto& [code, kind] : rows) try {
            throw_system("what", code);
        } catch (const LineError& error) {
            EXPECT_EQ(error.kind(), kind);
            EXPECT_TRUE(std::string_view{error.what()}.starts_with("what: "));
        }
}

// ---- TCP ---------------------------------------------------------------------------------------------------------

Descriptor connect_to(const Port& port) {
    const std::string place = port.place();
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    address.sin_port = htons(static_cast<std::uint16_t>(std::stoi(place.substr(place.rfind(':') + 1))));
    Descriptor fd{::socket(AF_INET, SOCK_STREAM, 0)};
    EXPECT_EQ(::connect(fd.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
    ::fcntl(fd.get(), F_SETFL, O_NONBLOCK);
    return fd;
}

TEST(Tcp, VisitorsComeAndGo) {
    OpenLine open{"tcp:127.0.0.1:0", Role::serve};
    Echoer slave;
    ASSERT_TRUE(open.line().segment().attach(slave));
    for (int i = 0; i < 3; ++i) {
        const Descriptor master = connect_to(open.port());
        EXPECT_EQ(exchange(open.line(), master.get(), kStatus8, 1), Octets{0xE5});
    }
}

TEST(Tcp, IsAHubForSeveralVisitors) {
    OpenLine open{"tcp:0", Role::serve};
    Echoer slave;
    ASSERT_TRUE(open.line().segment().attach(slave));
    const Descriptor one = connect_to(open.port()), two = connect_to(open.port());
    open.line().run(1_ms);
    EXPECT_EQ(exchange(open.line(), one.get(), kStatus8, 1), Octets{0xE5});
    Octets overheard = kStatus8;
    overheard.push_back(0xE5);
    Octets got;
    open.line().run(kLimit, [&] {
        std::array<std::uint8_t, 64> buffer{};
        const ssize_t n = ::read(two.get(), buffer.data(), buffer.size());
        if (n > 0) got.insert(got.end(), buffer.begin(), buffer.begin() + n);
        return got.size() >= overheard.size();
    });
    EXPECT_EQ(got, overheard) << "the request of the other and its answer";
}

TEST(Tcp, NamesPortsThatAreBusyOrNobodys) {
    const auto first = open_port(parse_uri("tcp:0"), fdl::BaudCode::kbit_19_2);
    EXPECT_EQ(refused("tcp:" + first->place()), LineErrorKind::busy);
    EXPECT_EQ(refused("tcp:192.0.2.1:9000"), LineErrorKind::missing) << "not an address of this machine";
    std::string gone;
    { gone = open_port(parse_uri("tcp:0"), fdl::BaudCode::kbit_19_2)->place(); }
    EXPECT_EQ(refused("tcp:" + gone, Role::visit), LineErrorKind::missing);
}

TEST(Tcp, AVisitingLineIsToldWhenTheListenerIsGone) {
    auto listener = open_port(parse_uri("tcp:0"), fdl::BaudCode::kbit_19_2);
    OpenLine visit{"tcp:" + listener->place(), Role::visit};
    EXPECT_EQ(visit.port().medium(), Medium::tcp);
    Reception r;
    listener->receive(r);  // accepts
    listener.reset();
    try {
        visit.line().run(kLimit);
        FAIL();
    } catch (const LineError& error) { EXPECT_EQ(error.kind(), LineErrorKind::gone); }
}

LiveLine* interrupted = nullptr;

TEST(Stopping, WorksFromASignalHandler) {
    OpenLine open{"pty", Role::serve};
    interrupted = &open.line();
    struct sigaction action {}, before {};
    action.sa_handler = [](int) { interrupted->stop(); };
    ASSERT_EQ(::sigaction(SIGALRM, &action, &before), 0);
    const itimerval soon{{0, 0}, {0, 10'000}};
    ASSERT_EQ(::setitimer(ITIMER_REAL, &soon, nullptr), 0);
    EXPECT_LT(open.line().run(600_s), 600_s);
    ::sigaction(SIGALRM, &before, nullptr);
}

}  // namespace
}  // namespace dpchip::live
