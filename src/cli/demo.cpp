// SPDX-License-Identifier: Apache-2.0
// `dpchip demo`: what `./run` shows. A second process of this program serves a virtual slave on a pty; this one drives it
// as DP master, says what happens, and what to try next. Ends by itself.
#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdio>
#include <vector>

#include <dpchip/cli/builtin_gsd.hpp>
#include <dpchip/cli/commands.hpp>
#include <dpchip/cli/log.hpp>
#include <dpchip/cli/master_session.hpp>
#include <dpchip/live/descriptor.hpp>

namespace dpchip::cli {
namespace {

const std::vector<std::string> kModules{"16 DI / 16 DO", "2 AI, consistent", "2 AO, consistent"};
constexpr int kAddress = 5;

/// `dpchip serve` as a child, its stdout a pipe to us.
class ServeProcess {
public:
    explicit ServeProcess(const std::vector<std::string>& arguments);
    ~ServeProcess();
    ServeProcess(const ServeProcess&) = delete;
    ServeProcess& operator=(const ServeProcess&) = delete;

    /// The next line of its stdout; empty when it has none to give within ten seconds.
    std::string line();
    /// SIGTERM; returns what it says before it ends, and its exit code.
    std::string finish(int& code);

private:
    bool read_some(int timeout_ms);

    pid_t pid_ = -1;
    live::Descriptor out_;
    std::string said_;
};

ServeProcess::ServeProcess(const std::vector<std::string>& arguments) {
    std::array<int, 2> ends{};
    if (::pipe2(ends.data(), O_CLOEXEC) != 0) throw Failure{ExitCode::failed, "pipe: out of descriptors"};
    out_ = live::Descriptor{ends[0]};
    const live::Descriptor theirs{ends[1]};
    std::vector<std::string> all{"dpchip", "serve"};
    all.insert(all.end(), arguments.begin(), arguments.end());
    std::vector<char*> argv;
    argv.reserve(all.size() + 1);
    for (std::string& a : all) argv.push_back(a.data());
    argv.push_back(nullptr);
    const pid_t parent = ::getpid();
    pid_ = ::fork();
    if (pid_ < 0) throw Failure{ExitCode::failed, "fork: no more processes"};
    if (pid_ != 0) return;
    ::prctl(PR_SET_PDEATHSIG, SIGTERM);  // it must not outlive its parent
    if (::getppid() != parent || ::dup2(theirs.get(), STDOUT_FILENO) < 0) ::_exit(126);
    ::execv("/proc/self/exe", argv.data());
    ::_exit(127);
}

ServeProcess::~ServeProcess() {
    if (pid_ <= 0) return;
    ::kill(pid_, SIGTERM);
    while (::waitpid(pid_, nullptr, 0) < 0 && errno == EINTR) {}
}

bool ServeProcess::read_some(int timeout_ms) {
    pollfd fd{out_.get(), POLLIN, 0};
    if (::poll(&fd, 1, timeout_ms) <= 0) return false;
    std::array<char, 4096> buffer{};
    const ssize_t got = ::read(out_.get(), buffer.data(), buffer.size());
    if (got <= 0) return false;
    said_.append(buffer.data(), static_cast<std::size_t>(got));
    return true;
}

std::string ServeProcess::line() {
    while (said_.find('\n') == std::string::npos)
        if (!read_some(10'000)) return {};
    const std::size_t end = said_.find('\n');
    std::string first = said_.substr(0, end);
    said_.erase(0, end + 1);
    return first;
}

std::string ServeProcess::finish(int& code) {
    ::kill(pid_, SIGTERM);
    while (read_some(10'000)) {}
    int status = 0;
    while (::waitpid(pid_, &status, 0) < 0 && errno == EINTR) {}
    pid_ = -1;
    code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    return said_;
}

std::string module_text() {
    std::string text;
    for (const std::string& m : kModules) text += (text.empty() ? "" : ", ") + ('"' + m + '"');
    return text;
}

LineConfig master_side(const std::string& path) {
    LineConfig config;
    config.line = path;
    SlaveEntry slave;
    slave.gsd = kBuiltinRemoteIo;
    slave.modules = kModules;
    slave.address = kAddress;
    slave.io = "echo";
    config.slaves.push_back(std::move(slave));
    return config;
}

void next_commands() {
    std::fputs("\nNow try:\n"
               "  dpchip serve --gsd builtin:remote_io --module \"8 DI\" --module \"8 DO\" --address 5 --line pty:/tmp/dp0\n"
               "      and, in another terminal, with your own master on /tmp/dp0 (8E1), or with this one:\n"
               "  dpchip master run --line /tmp/dp0 --gsd builtin:remote_io --module \"8 DI\" --module \"8 DO\" --address 5 --io echo\n"
               "  dpchip master scan --line /tmp/dp0          who is there?\n"
               "  dpchip gsd FILE.gsd --modules               what a GSD file says\n"
               "  dpchip sim examples/scenario.toml           a whole bus in virtual time\n"
               "  dpchip --help\n",
               stdout);
    std::fflush(stdout);
}

ExitCode run() {
    std::printf("A virtual DP slave on a pty (a second process of this program), and a DP master that drives it.\n\n"
                "slave   %s, address %d, VPC3+C, modules %s; inputs repeat outputs\n",
                std::string{kBuiltinRemoteIo}.c_str(), kAddress, module_text().c_str());
    std::fflush(stdout);
    std::vector<std::string> arguments{"--gsd", std::string{kBuiltinRemoteIo}, "--address", std::to_string(kAddress), "--io", "echo", "--line", "pty"};
    for (const std::string& m : kModules) arguments.insert(arguments.end(), {"--module", m});
    ServeProcess serve{arguments};
    const std::string ready = serve.line();
    constexpr std::string_view kReady = "ready pty=";
    if (!ready.starts_with(kReady)) throw Failure{ExitCode::failed, "the slave's process did not get ready"};
    const std::string path = ready.substr(kReady.size());
    std::printf("line    %s at 19.2 kbit/s\nmaster  address 1; the slave first has to find the baud rate, as the chip does\n\n", path.c_str());
    std::fflush(stdout);
    SessionOptions options;
    options.cycles = 100;
    options.duration = core::seconds(20);  // also on a machine that is very busy there is an end
    const ExitCode driven = MasterSession{master_side(path), options}.run();
    int code = 0;
    const std::string summary = serve.finish(code);
    std::printf("\nThe slave's side:\n%s", summary.c_str());
    if (driven != ExitCode::ok || code != 0) return ExitCode::failed;
    next_commands();
    return ExitCode::ok;
}

}  // namespace

void add_demo(CLI::App& app, Job& job) {
    CLI::App* const c = app.add_subcommand("demo", "a virtual slave and a master on a pty, for a few seconds");
    c->footer(footer("  dpchip demo"));
    c->callback([&job] { job = [] { return run(); }; });
}

}  // namespace dpchip::cli
