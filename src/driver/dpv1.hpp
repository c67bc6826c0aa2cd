// SPDX-License-Identifier: Apache-2.0
// DP-V1 for Vpc3: Vpc3<Bus, App, N, Dpv1<Connections, Alarms>>. MS1 on SAPs 51 and 50, MS2 on 49 and below, alarms and
// status messages in the diagnosis, identification (VPC3+C 7.2; reference 5, 10.12 to 10.14). Without it, Vpc3 has no
// code and no data of it.
//
// Time: the timeouts of MS2 run on User_Timer_Clock when Config::user_timer is on; else the program calls tick() with
// the milliseconds that have passed. Their units are hundreds of milliseconds: every 10 ms is plenty.
//
// A Set_Prm of seven octets raises no interrupt: one that follows a LEAVE-MASTER out of WAIT-CFG is not noticed, and the
// DPV1_Status octets of the one before it still count.
//
// Not here: MS3, function invocation, Set_Ext_Prm blocks, Data_Transport on MS1.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include <dpchip/driver/alarm_queue.hpp>
#include <dpchip/driver/msac2.hpp>
#include <dpchip/driver/vpc3.hpp>

namespace dpchip::driver {
namespace detail {

/// What Vpc3 has to do after an event.
struct AcyclicDemand {
    bool leave_master{};   ///< the master has broken the rules of MS1
    bool new_diagnosis{};  ///< block() has changed
};

/// The DPV1_Status octets of a Set_Prm.
struct Dpv1Status {
    std::uint8_t status_1{}, status_2{}, status_3{};
    constexpr bool enabled() const { return (status_1 & dp::kDpv1Enable) != 0; }
};

template <BusPort Bus, class App, std::size_t Connections, std::size_t Alarms>
class Acyclic {
public:
    static constexpr std::size_t kConnections = Connections;

    Acyclic(Bus bus, App& app) : list_{bus}, app_{&app}, ms2_{list_, app, scratch_} {}
    Acyclic(const Acyclic&) = delete;
    Acyclic& operator=(const Acyclic&) = delete;

    /// The layout for this driver, or what is wrong with the configuration.
    static constexpr AcyclicLayout lay_out(const Config& config, const Layout& cyclic) {
        AcyclicLayout layout = lay_out_acyclic(config, cyclic);
        if (layout.error == ConfigError::none && config.dpv1.connections > Connections) layout.error = ConfigError::connections;
        return layout;
    }

    // ---- life, in the order of Vpc3 ---------------------------------------------------------------------------------
    void configure(const AcyclicConfig& config, const AcyclicLayout& layout) {
        config_ = config;
        layout_ = layout;
        status_ = {};
        ms1_open_ = false;
    }
    const AcyclicLayout& layout() const { return layout_; }
    const AcyclicConfig& config() const { return config_; }
    void start(std::uint8_t own_address) {
        own_address_ = own_address;
        status_ = {};
        demand_ = {};
        list_.set_up(layout_, own_address);
        ms2_.start(config_, own_address);
    }
    void offline() {
        data_exch_left();
        ms2_.stop();
    }

    // ---- events -----------------------------------------------------------------------------------------------------
    void baud(std::uint8_t code) { ms2_.set_baud(code); }
    void address(std::uint8_t own_address) {
        own_address_ = own_address;
        ms2_.set_own_address(own_address);
        if (!ms1_open_) lock_ms1();
    }
    /// A Set_Prm has been accepted. In DATA-EXCH MS1 goes on with the new settings.
    void prm_accepted(const Dpv1Status& status, bool in_data_exch) {
        status_ = status;
        if (!in_data_exch || !status.enabled()) close_ms1();
        if (alarms_.is_open()) status.enabled() ? open_alarms() : close_alarms();
    }
    /// A Chk_Cfg has been accepted, of this master.
    void cfg_accepted(std::uint8_t master) {
        if (ms1_open_ || !status_.enabled() || !(layout_.ms1 || layout_.alarm)) return;
        ms1_open_ = true;
        ms1_ = {.serial = static_cast<std::uint8_t>(ms1_.serial + 1)};
        master_ = master;
        const Requester who{static_cast<std::uint8_t>(master | 0x80u), dp::kMasterSapMs1};
        for (const std::uint8_t ch : {channel::ms1, channel::alarm})
            if (layout_.has(ch)) list_.open(ch, who);
        app_->ms1_opened(master);
    }
    void data_exch_left() {
        status_ = {};
        close_ms1();
        close_alarms();
    }
    /// DX_Out in DATA-EXCH: with the first one the alarms start.
    void data_exchange() {
        if (!alarms_.is_open() && status_.enabled() && config_.max_alarm != 0) open_alarms();
    }
    void poll_end() {
        for (const std::uint8_t ch : {channel::ms1, channel::alarm})
            if (layout_.has(ch)) list_.take_response_sent(ch);
        ms2_.serve_poll_end();
    }
    void fdl_ind() {
        for (const std::uint8_t ch : {channel::ms1, channel::alarm})
            if (layout_.has(ch) && list_.has_request(ch, Buffer::first)) serve_ms1(ch);
        ms2_.serve_requests();
    }
    void tick(std::uint32_t ms) { ms2_.tick(ms); }
    AcyclicDemand take_demand() {
        if (alarms_.advance()) demand_.new_diagnosis = true;
        const AcyclicDemand now = demand_;
        demand_ = {};
        return now;
    }

    // ---- the application's calls --------------------------------------------------------------------------------------
    bool complete(const Handle& h, const RecordAnswer& answer, std::span<const std::uint8_t> data) {
        if (h.sap != dp::kSapMs1) return ms2_.complete(h, answer, data);
        if (answer.kind == RecordAnswer::Kind::later || ms1_.waiting != RelationState::Waiting::record || h.serial != ms1_.serial)
            return false;
        ms1_.waiting = RelationState::Waiting::none;
        std::array<std::uint8_t, dp::kRecordHeader> head{};
        list_.peek_request(channel::ms1, Buffer::first, head);
        const std::size_t limit = std::min(head[3], config_.ms1_max_data);
        respond(channel::ms1, reply_to(static_cast<dp::AcyclicFunction>(head[0]), {head[1], head[2], head[3]}, answer,
                                       data.first(std::min(data.size(), limit))));
        return true;
    }
    bool complete(const Handle& h, const InitiateAnswer& answer) { return ms2_.complete(h, answer); }
    bool abort(std::uint8_t sap, std::uint8_t reason) { return ms2_.abort(sap, reason); }
    AlarmRaised raise(const dp::AlarmStatus& a) { return alarms_.raise(a, config_.max_alarm); }

    // ---- the diagnosis ------------------------------------------------------------------------------------------------
    std::span<const std::uint8_t> block() const { return alarms_.block(); }
    void handed_over() { alarms_.handed_over(); }
    bool waits_for_fetch() const { return alarms_.waits_for_fetch(); }
    void fetched() { alarms_.fetched(); }

    bool ms1_open() const { return ms1_open_; }
    /// Check_Cfg_Mode of the present parameters.
    bool user_checks_cfg() const { return status_.enabled() && (status_.status_2 & dp::kCheckCfgMode) != 0; }
    C2State connection(std::size_t n) const { return ms2_.state(n); }

private:
    void open_alarms() {
        const std::uint8_t total = dp::alarm_limit(status_.status_3);
        const bool each_type = config_.alarm_sequence == 0;
        const std::uint8_t limit = each_type ? total : std::min(total, config_.alarm_sequence);
        alarms_.open(status_.status_2 & config_.alarms, limit, each_type);
    }
    void close_alarms() {
        if (!alarms_.block().empty()) demand_.new_diagnosis = true;
        alarms_.close([this](const dp::AlarmAck& id) { app_->alarm_dropped(id); });
    }
    void lock_ms1() {
        for (const std::uint8_t ch : {channel::ms1, channel::alarm})
            if (layout_.has(ch)) list_.lock(ch, own_address_);
    }
    void close_ms1() {
        if (!ms1_open_) return;
        ms1_open_ = false;
        lock_ms1();
        for (const std::uint8_t ch : {channel::ms1, channel::alarm}) {
            if (!layout_.has(ch)) continue;
            list_.release(ch, Buffer::first);
            list_.take_response_sent(ch);
        }
        const bool waiting = ms1_.waiting != RelationState::Waiting::none;
        ms1_.waiting = RelationState::Waiting::none;
        if (waiting) app_->request_dropped({dp::kSapMs1, ms1_.serial});
        app_->ms1_closed();
    }
    void serve_ms1(std::uint8_t ch) {
        const dp::Octets pdu = list_.read_request(ch, Buffer::first, scratch_.request);
        if (!ms1_open_ || pdu.empty()) return list_.release(ch, Buffer::first);
        const auto function = static_cast<dp::AcyclicFunction>(pdu[0]);
        if (function == dp::AcyclicFunction::alarm_ack) return respond(ch, acknowledge(pdu));
        const bool record = function == dp::AcyclicFunction::ds_read || function == dp::AcyclicFunction::ds_write;
        if (ch != channel::ms1 || !record) {
            list_.release(ch, Buffer::first);
            demand_.leave_master = true;
            return;
        }
        ms1_.serial = static_cast<std::uint8_t>(ms1_.serial + 1);
        RecordService<App> service{*app_, ms1_, config_.ms1_max_data, config_.identification, scratch_.answer};
        const RecordCall call{.handle = {dp::kSapMs1, ms1_.serial}, .relation = Relation::ms1, .master = master_};
        const Reply reply = service.serve(call, pdu);
        if (ms1_open_ && !reply.later) respond(ch, reply);
    }
    void respond(std::uint8_t ch, const Reply& reply) { list_.respond(ch, reply.head_span(), reply.data); }
    /// The answer repeats what was asked; an alarm that is not outstanding is a conflict of states.
    Reply acknowledge(dp::Octets pdu) {
        const auto asked = dp::decode_alarm_ack(pdu);
        if (!asked) return negative(dp::AcyclicFunction::alarm_ack, dp::ErrorCode1::type_conflict);
        dp::AlarmAck id = *asked;
        if (!alarms_.acknowledge(id)) return negative(dp::AcyclicFunction::alarm_ack, dp::ErrorCode1::state_conflict);
        app_->alarm_acknowledged(id);
        Reply r{};
        static_cast<void>(dp::encode(*asked, r.head));
        r.head_octets = dp::kRecordHeader;
        return r;
    }

    SapList<Bus> list_;
    App* app_;
    Scratch scratch_{};
    Msac2<Bus, App, Connections> ms2_;
    AcyclicConfig config_{};
    AcyclicLayout layout_{};
    RelationState ms1_{};
    AlarmQueue<Alarms> alarms_{};
    Dpv1Status status_{};
    AcyclicDemand demand_{};
    std::uint8_t own_address_ = 126, master_ = 0;
    bool ms1_open_ = false;
};

}  // namespace detail

/// DP-V1 for Vpc3. Connections: class-2 connections that the driver has memory for; the chip's RAM must hold their
/// buffers too. Alarms: how many may wait or be outstanding, status messages included, about 70 octets each.
template <std::size_t Connections = 2, std::size_t Alarms = 8>
struct Dpv1 {
    static_assert(Connections <= kMaxConnections && Alarms >= 1 && Alarms <= 32);
    static constexpr bool present = true;
    template <BusPort Bus, class App>
    using Engine = detail::Acyclic<Bus, App, Connections, Alarms>;
};

}  // namespace dpchip::driver
