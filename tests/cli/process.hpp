// SPDX-License-Identifier: Apache-2.0
// The built program as a child process: what it writes, how it ends. No waiting but for its output and its end.
#pragma once

#include <string>
#include <vector>

#include <sys/types.h>

namespace dpchip::test {

/// `dpchip ARGUMENTS...` with stdout and stderr on pipes. Killed when it outlives this object.
class Program {
public:
    explicit Program(const std::vector<std::string>& arguments, const std::string& input = {});
    ~Program();
    Program(const Program&) = delete;
    Program& operator=(const Program&) = delete;

    /// The next line of stdout, without newline; empty when it ends, or says nothing for a minute.
    std::string line();
    /// Waits until stderr says `words`; false when it ends, or does not for a minute.
    bool said(const std::string& words);
    /// Sends a signal.
    void signal(int number) const;
    /// Waits for the end; returns the exit code, or 1000 + the signal that killed it.
    int wait();
    /// Everything written so far that line() has not taken; complete after wait().
    const std::string& out() const { return out_; }
    const std::string& err() const { return err_; }

private:
    bool read_some();

    pid_t pid_ = -1;
    int out_fd_ = -1, err_fd_ = -1;
    std::string out_, err_;
    int code_ = -1;
};

/// What a run to the end gave.
struct Result {
    int code = -1;
    std::string out, err;
};
Result run(const std::vector<std::string>& arguments, const std::string& input = {});

}  // namespace dpchip::test
