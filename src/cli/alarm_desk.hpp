// SPDX-License-Identifier: Apache-2.0
// The alarms of a master's slaves: received from the diagnosis, acknowledged over MS1, kept in words. For the slaves whose
// [[slave]] enables alarms.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include <dpchip/cli/application.hpp>
#include <dpchip/cli/stations.hpp>
#include <dpchip/master/alarm_receiver.hpp>
#include <dpchip/master/master.hpp>
#include <dpchip/trace/gsd_texts.hpp>

namespace dpchip::cli {

class AlarmDesk {
public:
    struct Line {
        Ticks at{};
        std::size_t slave{};               ///< in the master's order
        bool status{};
        std::string text;                  ///< "Diagnostic_Alarm slot 1 Seq_Nr 0 appears: 01 00"
        std::vector<std::string> details;  ///< texts of the GSD
    };

    /// A relation for each of `slaves`, in the master's order, that enables alarms. `master` must outlive the desk.
    AlarmDesk(master::Master& master, const std::vector<SlaveEntry>& slaves, GsdShelf& shelf);
    ~AlarmDesk();
    AlarmDesk(const AlarmDesk&) = delete;
    AlarmDesk& operator=(const AlarmDesk&) = delete;

    /// From the master's cycle hook.
    void look();
    /// What has come since the last call, with `now`.
    std::vector<Line> take(Ticks now);
    bool empty() const { return desks_.empty(); }
    std::uint64_t alarms() const { return sum([](const Desk& d) { return d.receiver.alarms(); }); }
    std::uint64_t status_messages() const { return sum([](const Desk& d) { return d.receiver.status_messages(); }); }
    std::uint64_t acknowledged() const { return sum([](const Desk& d) { return d.ms1.acknowledged(); }); }

private:
    struct Desk {
        Desk(std::size_t n, const master::SlaveHandler& s, const master::Ms1Config& config) : slave{n}, ms1{config}, receiver{s, ms1} {}
        std::size_t slave;
        master::Ms1 ms1;
        master::AlarmReceiver receiver;
    };
    template <class F>
    std::uint64_t sum(F&& of) const {
        std::uint64_t total = 0;
        for (const auto& d : desks_) total += of(*d);
        return total;
    }

    master::Master* master_;
    trace::GsdTexts texts_;
    std::vector<std::unique_ptr<Desk>> desks_;
};

/// A master's cycle hook: what its application does, and alarms.
struct CycleHook {
    Application* application = nullptr;
    AlarmDesk* alarms = nullptr;
    void operator()(master::Master& m) {
        (*application)(m);
        alarms->look();
    }
};

/// Texts of the GSD for the bits of an alarm or status message.
std::vector<std::string> alarm_details(const dp::AlarmStatus& alarm, std::uint8_t station, const trace::DeviceTexts& texts);
/// As the wire had it; the data are those of `received`.
dp::AlarmStatus alarm_of(const master::ReceivedAlarm& received);

}  // namespace dpchip::cli
