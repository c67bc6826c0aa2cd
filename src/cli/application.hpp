// SPDX-License-Identifier: Apache-2.0
// What a master of this program does with its slaves: outputs that change in every cycle, and a check that the inputs
// are what the slave's I/O behaviour makes of them.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <dpchip/master/master.hpp>
#include <dpchip/slave/io_behaviour.hpp>

namespace dpchip::cli {

class Application {
public:
    /// Outputs of a slave and what to expect from it.
    struct Wish {
        std::optional<slave::IoBehaviour> io{};           ///< nothing: inputs are not checked
        std::optional<std::vector<std::uint8_t>> outputs; ///< constant, cut or filled with zeros; else they change when `io` is known
    };
    struct Checked {
        std::uint64_t exchanges = 0;  ///< seen
        std::uint64_t compared = 0;
        std::uint64_t wrong = 0;
        std::string first_wrong;      ///< in words
    };

    /// One wish for each slave, in the master's order.
    explicit Application(std::vector<Wish> wishes);
    /// The master's cycle hook.
    void operator()(master::Master& master);
    /// Outputs do not arrive as they are now: Sync, Freeze, Clear. Checking resumes a few cycles later.
    void disturb(bool disturbed);
    /// The slave behaves differently from now on.
    void expect(std::size_t n, const slave::IoBehaviour& io);
    const Checked& checked(std::size_t n) const { return slaves_[n].checked; }
    std::uint64_t compared() const;
    std::uint64_t wrong() const;

private:
    struct Slave {
        Wish wish;
        Checked checked;
        std::uint64_t seen = 0, lost = 0;
        bool in_step = false;                ///< `sent` is what the slave answers to next
        std::vector<std::uint8_t> sent;
        std::vector<std::uint8_t> last;      ///< inputs before
        std::vector<std::uint8_t> expected;
    };

    void look(Slave& s, const master::SlaveHandler& h);
    void compare(Slave& s, const master::SlaveHandler& h);
    void set_outputs(const Slave& s, std::size_t n, master::SlaveHandler& h) const;

    std::vector<Slave> slaves_;
    std::uint64_t round_ = 0;
    bool disturbed_ = false;
    unsigned settling_ = 0;  ///< cycles until inputs are checked again
};

}  // namespace dpchip::cli
