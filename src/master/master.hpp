// SPDX-License-Identifier: Apache-2.0
// A DP master of class 1 as a station: token to itself, one request to each slave, then what is acyclic, and again
// (reference 1.6, 2.5, 3; cycle time n * T_MC + 33 + TID1).
//
// The cycle allocates nothing. The application reads inputs and writes outputs between cycles, best in the hook.
// It needs no other clock than advance(), so the same master works on a live line, given a longer slot time.
// Not modelled: other masters (it keeps quiet while it hears one and takes the bus when it is silent).
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include <dpchip/core/fixed_queue.hpp>
#include <dpchip/core/result.hpp>
#include <dpchip/dp/global_control.hpp>
#include <dpchip/fdl/transmission.hpp>
#include <dpchip/master/config.hpp>
#include <dpchip/master/frame_count.hpp>
#include <dpchip/master/job.hpp>
#include <dpchip/master/relation.hpp>
#include <dpchip/master/slave_handler.hpp>

namespace dpchip::master {

struct CycleStatistics {
    std::uint64_t cycles = 0;
    Ticks last{}, min = core::kNever, max{};  ///< from token to token; isochronous: from SYNCH to SYNCH
    std::uint64_t overruns = 0;               ///< SYNCHs left out because a cycle took too long
};

struct MasterCounters {
    std::uint64_t requests = 0;    ///< sent, repetitions included
    std::uint64_t answers = 0;     ///< good ones, in time and from the right station
    std::uint64_t retries = 0;
    std::uint64_t timeouts = 0;    ///< slot times without answer
    std::uint64_t damaged = 0;     ///< answers with character errors
    std::uint64_t foreign = 0;     ///< telegrams that belong to somebody else
};

class Master {
public:
    explicit Master(const MasterConfig& config = {});
    Master(const Master&) = delete;             // a line holds its address
    Master& operator=(const Master&) = delete;

    // ---- setting up (allocates) ---------------------------------------------------------------------------------
    /// Adds a slave; its number counts from 0 in the order of adding, which is the order of the cycle.
    core::Result<std::size_t, ConfigError> add(const SlaveConfig& slave);
    /// Called after each cycle, before the next token, with `context`.
    using CycleHook = void (*)(void* context, Master& master);
    void on_cycle(CycleHook hook, void* context) { hook_ = hook; hook_context_ = context; }
    /// The same with a callable that outlives the master.
    template <class F>
    void on_cycle(F& hook) {
        on_cycle([](void* f, Master& m) { (*static_cast<F*>(f))(m); }, &hook);
    }

    // ---- application, between cycles ----------------------------------------------------------------------------
    const MasterConfig& config() const { return config_; }
    std::size_t size() const { return slaves_.size(); }
    SlaveHandler& slave(std::size_t n) { return *slaves_[n]; }
    const SlaveHandler& slave(std::size_t n) const { return *slaves_[n]; }
    /// The slave with this address, or null.
    SlaveHandler* find(std::uint8_t address);
    std::size_t exchanging() const;
    bool all_exchanging() const { return exchanging() == slaves_.size(); }

    Mode mode() const { return mode_; }
    /// From the next cycle on; clear and operate are announced with Global_Control. After offline the bus is taken
    /// as at power-up. Call Segment::touch() when coming from offline.
    void set_mode(Mode mode);
    /// A backup master of the same address and slaves, offline until now, goes on where `primary` was: with its outputs,
    /// its inputs and its frame count bits, so that the slaves notice nothing. `primary` must be off the line or offline.
    /// False when address or slaves differ. Call Segment::touch() afterwards.
    bool take_over(const Master& primary);
    /// Global_Control after the cyclic part of this cycle: Sync, Freeze and their kind. False when 8 are waiting.
    bool global_control(const dp::GlobalControl& command);
    /// Hands over a job; it stays the caller's and must live until finished() or cancel(). False when 16 are
    /// waiting or the address is above 127.
    bool submit(Job& job);
    void cancel(Job& job);
    /// Lets an acyclic relation take its turns with the others, one request at a time, beside the jobs. It stays the
    /// caller's and must live until detach(). Allocates.
    void attach(Relation& relation);
    void detach(Relation& relation);
    /// Asks every address but its own for FDL_Status and Slave_Diag, one request a cycle.
    void start_scan();
    bool scanning() const { return scan_address_ != kNotScanning; }
    const std::array<Found, 127>& found() const { return found_; }

    const CycleStatistics& cycle() const { return cycle_; }
    const MasterCounters& counters() const { return counters_; }
    /// Forgets minimum and maximum and starts to count cycles anew.
    void clear_statistics() { cycle_ = {}; counters_ = {}; cycle_measured_ = false; }

    // ---- Station ------------------------------------------------------------------------------------------------
    Ticks next() const;
    void advance(Ticks t);
    void hear(const fdl::Transmission& t);
    void hear_character(const fdl::Character& c);
    void carrier(Ticks at);
    bool take(fdl::Transmission& t);
    bool hears_all() const { return mode_ != Mode::offline; }
    /// None while offline, so that a backup may hang on the same line.
    std::uint8_t address() const { return mode_ == Mode::offline ? std::uint8_t{255} : config_.address; }

private:
    /// The parts of a cycle, in order.
    enum class Step : std::uint8_t { claim, synch, token, slave, absent, command, time_event, clock_value, job, scan, gap, pass, end };
    enum class Phase : std::uint8_t {
        silent,    ///< offline
        waiting,   ///< for send_at_
        ready,     ///< sends at this very tick
        draining,  ///< sends something that has no answer
        asking,    ///< the request is out, nobody answers yet
        hearing,   ///< somebody is sending
    };
    static constexpr std::uint8_t kNotScanning = 255;
    static constexpr std::uint8_t kLastAddress = 126;

    Ticks bits(std::int64_t n) const { return bit_ * n; }
    Ticks present() const { return std::max(now_, heard_); }
    bool isochron() const { return config_.isochron.cycle != Ticks{}; }
    bool active() const { return mode_ == Mode::clear || mode_ == Mode::operate; }

    // the cycle
    void take_bus();
    Ticks synch_time(Ticks earliest);
    bool fits_in_cycle() const;
    std::size_t compose_clock_value(std::span<std::uint8_t> out);
    void begin_cycle();
    void choose();
    bool step_has_work();
    bool absent_due();
    bool acyclic_due();
    bool job_due();
    bool relation_due();
    void step_done(Ticks end, std::int64_t idle_bits);
    void measure();

    // one message cycle
    bool wants_answer() const;
    bool may_repeat() const;
    std::uint8_t asked() const;
    std::size_t polled() const { return step_ == Step::absent ? absent_turn_ : turn_; }
    std::size_t compose(std::span<std::uint8_t> out);
    bool expected(const fdl::Telegram& t) const;
    void answered(const fdl::Telegram& t, Ticks end);
    void no_answer();
    void give_up();
    void resume(Ticks quiet_from);

    // jobs and the scan
    std::size_t compose_job(std::span<std::uint8_t> out) const;
    void job_answered(const fdl::Telegram& t);
    void job_finished(Job::Outcome outcome);
    std::uint8_t job_fc() const;
    void forsake(Job& job);
    void scan_goes_on();
    void scan_next();

    MasterConfig config_;
    Ticks bit_{};
    Ticks slot_{};
    Mode mode_;
    Mode announced_ = Mode::stop;    ///< what the slaves were told by Global_Control

    Phase phase_ = Phase::silent;
    Step step_ = Step::claim;
    std::size_t turn_ = 0;           ///< slave whose turn it is
    std::size_t absent_turn_ = 0;    ///< absent slave asked for last
    std::size_t absent_left_ = 0;    ///< absent slaves still to be asked for in this cycle
    std::uint8_t acyclic_left_ = 0;  ///< acyclic requests still possible in this cycle
    bool outstanding_ = false;       ///< a request is out and not done with
    std::uint8_t retries_left_ = 0;
    Ticks now_{};
    Ticks heard_{};                  ///< end of what was heard last
    Ticks send_at_ = core::kNever;   ///< waiting: the next request; draining: end of the present telegram
    Ticks deadline_ = core::kNever;  ///< asking: end of the slot time; hearing: when to stop believing in it
    Ticks slot_end_{};               ///< of the present request
    Ticks own_end_{};

    std::vector<std::unique_ptr<SlaveHandler>> slaves_;
    std::array<std::int16_t, 128> by_address_;  ///< slave number, or -1
    std::array<FrameCount, 128> frames_{};      ///< towards stations that are no slaves of this master
    core::FixedQueue<dp::GlobalControl, 8> commands_;
    dp::GlobalControl command_{};    ///< the one being sent
    core::FixedQueue<Job*, 16> jobs_;
    Job* job_ = nullptr;             ///< the one being asked, the scan's and the relations' included
    std::vector<Relation*> relations_;
    std::size_t relation_turn_ = 0;  ///< the next to be asked whether it has something to ask
    Relation* asking_ = nullptr;     ///< whose job it is
    bool relations_first_ = false;   ///< jobs had their turn
    Job scan_job_{};
    Job spare_job_{};               ///< takes the answer of a job that was cancelled too late
    std::uint8_t scan_address_ = kNotScanning;
    std::array<Found, 127> found_{};
    std::uint8_t gap_address_ = kLastAddress;
    std::uint8_t gap_count_ = 0;

    Ticks synch_at_{};               ///< the SYNCH of this cycle, without jitter
    std::uint64_t random_ = 1;
    Ticks clock_due_{};              ///< the next Time_Event
    bool clock_value_due_ = false;
    dp::NetworkTime event_time_{}, previous_event_{};

    CycleHook hook_ = nullptr;
    void* hook_context_ = nullptr;
    Ticks cycle_start_{};
    bool cycle_measured_ = false;
    Ticks min_cycle_{};
    CycleStatistics cycle_;
    MasterCounters counters_;
};

}  // namespace dpchip::master
