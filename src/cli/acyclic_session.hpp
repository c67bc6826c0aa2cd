// SPDX-License-Identifier: Apache-2.0
// A relation for acyclic services to one slave on a live line: what `dpchip master read`, `write`, `identify` and `alarms`
// have in common.
//
// Class 1 makes the slave its own and brings it into data exchange with outputs 0; a slave that belongs to another master is
// left alone. Class 2 opens a connection and disturbs nobody.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include <dpchip/cli/live_master.hpp>
#include <dpchip/cli/slave_arguments.hpp>
#include <dpchip/master/alarm_receiver.hpp>
#include <dpchip/master/ms1.hpp>
#include <dpchip/master/ms2.hpp>

namespace dpchip::cli {

struct AcyclicArguments {
    LineArguments line;
    std::string gsd;
    std::vector<std::string> modules;
    int address = -1;
    int own_address = -1;
    int service_class = 1;
    double patience = 10;
};
/// --address, --gsd, --module, --timeout, --master-address and the line's options; with `choose_class` --class.
enum class ChooseClass : bool { no, yes };
void add_acyclic_arguments(CLI::App& command, AcyclicArguments& arguments, ChooseClass choose_class);

class AcyclicSession {
public:
    /// Opens the line. `alarms`: bits of DPV1_Status_2 to be enabled with class 1.
    explicit AcyclicSession(const AcyclicArguments& arguments, std::uint8_t alarms = 0);
    /// Leaves the slave as it should be, also after a failure.
    ~AcyclicSession();
    AcyclicSession(const AcyclicSession&) = delete;
    AcyclicSession& operator=(const AcyclicSession&) = delete;

    /// Gets the relation going. Throws Failure{failed} that says what is in the way.
    void open();
    master::Relation& relation() { return *relation_; }
    /// Class 1 only.
    master::Ms1& ms1() { return *ms1_; }
    const master::SlaveHandler& slave() { return live_.master().slave(0); }
    LiveMaster& live() { return live_; }
    std::uint8_t address() const { return address_; }
    const trace::DeviceTexts& texts() const { return texts_; }
    Ticks patience() const { return patience_; }
    /// Lives until the service under way has ended. Throws Failure{failed}, "slave 5: WHAT: refused: ...", unless it is done.
    void finish(const std::string& what);
    /// The same for what ends when `done` says so.
    template <class F>
    void finish(const std::string& what, F&& done, const master::ServiceResult& result) {
        if (!live_.run_until(done, patience_)) fail(what + ": not answered within the time");
        if (!result.done()) fail(what + ": " + master::text(result));
    }
    [[noreturn]] void fail(const std::string& why) const;

private:
    /// Ends the connection, or gives the slave free for other masters.
    void leave();
    void open_class_1();
    void open_class_2();
    master::Job ask(master::Job job, const char* what);
    master::SlaveConfig config_from_gsd() const;
    master::SlaveConfig config_from_slave();

    std::uint8_t address_;
    int class_;
    std::uint8_t alarms_;
    Ticks patience_;
    SlaveEntry entry_;             ///< gsd empty: nothing is known of the slave
    GsdShelf shelf_;
    const gsd::Gsd* gsd_ = nullptr;
    trace::GsdTexts texts_;
    LiveMaster live_;
    std::uint16_t ident_ = 0;
    std::unique_ptr<master::Ms1> ms1_;
    std::unique_ptr<master::Ms2> ms2_;
    master::Relation* relation_ = nullptr;
};

}  // namespace dpchip::cli
