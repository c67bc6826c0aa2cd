// SPDX-License-Identifier: Apache-2.0
// A scenario in virtual time: one master, virtual slaves, a judge, events.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <dpchip/cli/alarm_desk.hpp>
#include <dpchip/cli/application.hpp>
#include <dpchip/cli/line_config.hpp>
#include <dpchip/cli/stations.hpp>
#include <dpchip/cli/trace_file.hpp>
#include <dpchip/cli/wave_file.hpp>
#include <dpchip/master/master.hpp>
#include <dpchip/segment/judge.hpp>
#include <dpchip/segment/segment.hpp>

namespace dpchip::cli {

class Simulation {
public:
    /// Everything is powered up at time 0. Throws Failure.
    explicit Simulation(const LineConfig& config);
    Simulation(const Simulation&) = delete;
    Simulation& operator=(const Simulation&) = delete;

    /// Runs for `duration`, or until so many cycles with all slaves in data exchange and no event ahead are over; at most
    /// an hour of virtual time. Throws Failure when an event cannot happen.
    void run(std::optional<Ticks> duration, std::optional<std::uint64_t> cycles);
    /// Writes waveforms from now on. Throws Failure.
    void show_waves(const WaveOptions& options);

    struct Member {
        SlaveEntry entry;
        std::unique_ptr<slave::VirtualSlave> slave;
        segment::StationIndex index = segment::kNobody;
        bool on = false;                ///< powered
        bool plugged = false;           ///< on the line
        std::uint64_t exchanges = 0;    ///< of lives before a power_off
    };
    const LineConfig& config() const { return config_; }
    const std::vector<Member>& members() const { return members_; }
    const master::Master& master() const { return *master_; }
    const segment::Judge& judge() const { return judge_; }
    const Application& application() const { return *application_; }
    const AlarmDesk& alarm_desk() const { return *alarm_desk_; }
    /// Alarms and status messages that the master received, in their order.
    const std::vector<AlarmDesk::Line>& alarms() const { return alarms_; }
    /// Alarms of events that the slave could not tell anybody.
    std::uint64_t unheard() const { return unheard_; }
    Ticks now() const { return segment_.now(); }
    std::uint64_t faults() const { return faults_; }
    /// When all slaves were in data exchange for the first time; nothing: never.
    std::optional<Ticks> reached() const { return reached_; }
    /// Every slave that has power and a plug is in data exchange, the values were right, and nobody broke the rules of
    /// the bus but the faults of the scenario.
    bool good() const;

private:
    /// Faults of events, for the transmissions that they are for.
    struct Faults {
        struct Armed {
            segment::Fault fault;
            std::uint32_t left;
            segment::StationIndex sender;  ///< kNobody: any
        };
        std::vector<Armed> armed;
        std::uint64_t* count;
        segment::Fault operator()(const fdl::Transmission& t, segment::StationIndex sender, std::uint64_t number);
    };

    void happen(const EventEntry& event);
    void attach(Member& m);
    void detach(Member& m);
    void power_on(Member& m, const EventEntry& event);
    void arm(const EventEntry& event);
    void happen_to(Member& m, const EventEntry& event);
    void tell();
    void control(const EventEntry& event);
    void switch_over();
    void advance_to(Ticks end, std::optional<std::uint64_t> cycles);
    void look_at_waves();

    LineConfig config_;
    GsdShelf shelf_;
    segment::Segment segment_;
    segment::Judge judge_;
    std::vector<Member> members_;
    std::unique_ptr<master::Master> master_;
    segment::StationIndex master_index_{};
    std::unique_ptr<Application> application_;
    std::unique_ptr<AlarmDesk> alarm_desk_;
    CycleHook hook_;
    std::vector<AlarmDesk::Line> alarms_;
    std::uint64_t unheard_ = 0;
    std::uint64_t faults_ = 0;
    Faults fault_source_{{}, &faults_};
    std::unique_ptr<TraceFile> trace_;
    std::unique_ptr<WaveFile> waves_;
    std::optional<Ticks> reached_;
    std::uint8_t modes_ = 0;  ///< Sync and Freeze in force, as Control_Command bits
};

}  // namespace dpchip::cli
