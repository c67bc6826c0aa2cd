// SPDX-License-Identifier: Apache-2.0
// The model and the naive slave driven by the same steps, compared after each (issue: oracles; reference 4.13 for
// times).
//
// A Step holds everything that was drawn by lot, so a history can be replayed, cut and printed.
#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <random>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <dpchip/chip/chip.hpp>

#include "naive_slave.hpp"

namespace oracle {

using Variant = dpchip::regmap::Variant;
using Chip = dpchip::chip::Chip<dpchip::core::NoTrace>;

struct Step {
    enum class Kind { telegram, characters, read, write, wait, wait_next, reset, setup };
    Kind kind{};
    Octets octets;           ///< telegram, characters
    unsigned baud = 0;       ///< of the sender
    unsigned gap_tbit = 40;  ///< idle before the first start bit
    bool polite = true;      ///< waits for the slave's answer first
    int fault_at = -1;       ///< characters: damaged one
    unsigned fault = 0;      ///< 1 parity, 2 stop bit, 3 gap before it
    unsigned address = 0, value = 0;
    Time duration = 0;                                  ///< wait; before a processor access
    std::vector<std::pair<unsigned, unsigned>> writes;  ///< setup
};
std::string describe(const Step& step);

/// What the random run must have seen, and did see.
struct Coverage {
    std::set<std::string> answers;  ///< "DATA-EXCH owner Set_Prm SC"
    std::set<std::string> effects;  ///< "0E -> 01"
    std::map<std::string, std::uint64_t> counts;
};

/// One model and one naive slave.
class Pair {
public:
    Pair(Variant variant, bool motorola);

    /// Does the step on both; what differs afterwards, or an empty string.
    std::string run(const Step& step, Coverage* coverage = nullptr);

    NaiveSlave naive;
    Chip chip;

private:
    void advance(Time to);
    std::string send(const Step& step, Coverage* coverage);
    std::string access(const Step& step, Coverage* coverage);
    std::string compare();
    bool no_master_sends(const Octets& octets) const;
    void note_request(const Step& step);
    void note_answer(Coverage* coverage);

    std::vector<Sent> chip_sent_;
    std::string stuck_;
    std::string open_request_;  ///< "DATA-EXCH owner Set_Prm", waiting for its answer
};

/// Draws steps, with a bias towards DATA-EXCH. Looks at the naive slave only.
class Generator {
public:
    Generator(const Kind& kind, std::uint64_t seed) : kind_{kind}, random_{seed} {}
    Step setup();
    Step next(const NaiveSlave& slave);

private:
    unsigned draw(unsigned below) { return static_cast<unsigned>(random_() % below); }
    bool chance(unsigned percent) { return draw(100) < percent; }
    unsigned any(std::initializer_list<unsigned> of) { return *(of.begin() + draw(static_cast<unsigned>(of.size()))); }

    Step telegram(const NaiveSlave& slave);
    Step processor(const NaiveSlave& slave);
    Step buffer_write(const NaiveSlave& slave);
    Step wait();
    Step cpu_read(unsigned address);
    Step cpu_write(unsigned address, unsigned value);
    Octets request(const NaiveSlave& slave, unsigned master);
    Octets sap_request(const NaiveSlave& slave, unsigned master, unsigned dsap, const Octets& data,
                       unsigned function = 13);
    Octets plain_request(const NaiveSlave& slave, unsigned master, unsigned function, const Octets& data);
    Octets set_prm(const NaiveSlave& slave, bool good);
    Octets outputs(const NaiveSlave& slave);
    Octets random_data(unsigned length);
    Octets control(const NaiveSlave& slave, unsigned master);
    unsigned frame_count(unsigned master, unsigned function);

    Kind kind_;
    std::mt19937_64 random_;
    std::map<unsigned, int> fcb_;
    std::map<unsigned, Octets> last_;
    unsigned line_baud_ = 3;
};

}  // namespace oracle
