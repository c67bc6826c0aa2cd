// SPDX-License-Identifier: Apache-2.0
// What a class-1 master knows about one slave and does with it: from silence to cyclic data exchange and back
// (reference 2.5, 3.1, 3.7, 3.8). Pure reaction: it is asked for the next request and told what became of it.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <dpchip/dp/diag.hpp>
#include <dpchip/dp/saps.hpp>
#include <dpchip/fdl/telegram.hpp>
#include <dpchip/master/config.hpp>
#include <dpchip/master/frame_count.hpp>

namespace dpchip::master {

/// Where a slave is on its way to cyclic data exchange; each state is one request.
enum class SlaveState : std::uint8_t {
    absent,         ///< asked for with FDL_Status; has not answered, or not for long
    diagnosis,      ///< first Slave_Diag: whose is it, what is it
    parameters,     ///< Set_Prm
    configuration,  ///< Chk_Cfg
    ready_check,    ///< Slave_Diag until it is ready
    data_exchange,
};
const char* name(SlaveState state);

/// What keeps a slave from data exchange, or last did.
enum class SlaveFault : std::uint8_t {
    none,
    wrong_ident,      ///< another device at this address
    locked,           ///< another master owns it
    prm_fault,        ///< it refuses the parameters
    cfg_fault,        ///< it refuses the configuration
    not_supported,    ///< it cannot do Sync, Freeze or something else it was asked for
    invalid_answer,   ///< it answers with something else than the service allows
};
const char* name(SlaveFault fault);

struct SlaveCounters {
    std::uint64_t exchanges = 0;      ///< good Data_Exchange answers
    std::uint64_t diagnoses = 0;      ///< good Slave_Diag answers
    std::uint64_t retries = 0;
    std::uint64_t unanswered = 0;     ///< requests given up after the last retry
    std::uint64_t negative = 0;       ///< answers RS, RR, UE and their like
    std::uint64_t invalid = 0;        ///< answers of a wrong kind or length
    std::uint64_t lost = 0;           ///< times data exchange came to an end
};

class SlaveHandler {
public:
    explicit SlaveHandler(const SlaveConfig& config);

    // ---- for the application, between cycles --------------------------------------------------------------------
    const SlaveConfig& config() const { return config_; }
    SlaveState state() const { return state_; }
    bool exchanging() const { return state_ == SlaveState::data_exchange; }
    SlaveFault fault() const { return fault_; }
    /// The outputs of the next Data_Exchange.
    std::span<std::uint8_t> outputs() { return std::span{outputs_}.first(config_.output_octets); }
    std::span<const std::uint8_t> outputs() const { return std::span{outputs_}.first(config_.output_octets); }
    /// The inputs of the last Data_Exchange; kept when the slave is lost.
    std::span<const std::uint8_t> inputs() const { return std::span{inputs_}.first(config_.input_octets); }
    /// The last diagnosis, 6..244 octets; empty before the first.
    std::span<const std::uint8_t> diagnosis() const { return std::span{diagnosis_}.first(diagnosis_size_); }
    /// Reads the diagnosis at the slave's next turn, also in data exchange.
    void request_diagnosis() { diagnosis_wanted_ = true; }
    /// Starts over with Set_Prm at the next turn: after the configuration of the device changed.
    void restart() { if (state_ > SlaveState::diagnosis) state_ = SlaveState::diagnosis; }
    const SlaveCounters& counters() const { return counters_; }

    // ---- for the master -----------------------------------------------------------------------------------------
    /// Writes the request due now; returns its length. The same again for a retry.
    std::size_t compose(std::span<std::uint8_t> out, std::uint8_t master, Mode mode) const;
    /// An answer to it: SC, or a telegram from this slave to this master.
    void answered(const fdl::Telegram& t, std::uint8_t master);
    /// Nothing came, not even after the last retry.
    void unanswered();
    void note_retry() { ++counters_.retries; }
    /// The request due now is answered to everybody.
    bool multicast() const { return config_.publisher && state_ == SlaveState::data_exchange && !diagnosis_due(); }
    /// Asked for so often that it makes no sense to ask every cycle.
    bool given_up() const { return state_ == SlaveState::absent && tried_; }
    /// FC of a request with frame count bit; for jobs, which share the count with the cycle.
    std::uint8_t frame_count(fdl::Request r) const { return frames_.fc(r); }
    /// A request with frame count bit was answered, or given up.
    void count_frame(bool answered) { frames_.count(answered); }

private:
    void on_status(const fdl::Telegram& t);
    void on_diagnosis(const fdl::Telegram& t, std::uint8_t master);
    void on_exchange(const fdl::Telegram& t);
    void on_acknowledge(const fdl::Telegram& t, SlaveState good);
    void judge(const dp::DiagHeader& h, std::uint8_t master);
    bool diagnosis_due() const;
    void invalid();
    void lose(SlaveState to);

    SlaveConfig config_;
    std::vector<std::uint8_t> set_prm_;
    SlaveState state_ = SlaveState::absent;
    SlaveFault fault_ = SlaveFault::none;
    bool tried_ = false;
    bool diagnosis_wanted_ = false;
    FrameCount frames_{};
    std::size_t diagnosis_size_ = 0;
    SlaveCounters counters_;
    std::array<std::uint8_t, 244> outputs_{}, inputs_{}, diagnosis_{};
};

}  // namespace dpchip::master
