// SPDX-License-Identifier: Apache-2.0
// MS2: the resource manager on SAP 49 and the connections on SAPs 48 and below, each with its timers (reference 5.4,
// 10.13, 10.14).
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include <dpchip/driver/acyclic_events.hpp>
#include <dpchip/driver/record_service.hpp>
#include <dpchip/driver/sap_list.hpp>

namespace dpchip::driver::detail {

/// Two buffers for PDUs, shared by all relations: served one after the other.
struct Scratch {
    std::array<std::uint8_t, dp::kMaxAcyclicPdu> request{};
    std::array<std::uint8_t, dp::kMaxRecord> answer{};
};

/// Where a connection stands.
enum class C2State : std::uint8_t {
    closed,
    working,     ///< the application has the request
    responding,  ///< the answer waits for a poll
    awaiting,    ///< the next request
    aborting,    ///< an Abort waits for a poll
};

struct Connection {
    RelationState relation{};
    C2State state = C2State::closed;
    std::uint8_t master = 0;
    std::uint16_t send_timeout = 0;  ///< 10 ms
    std::uint32_t left = 0;          ///< ms until the present state times out
};

template <BusPort Bus, class App, std::size_t Connections>
class Msac2 {
public:
    Msac2(SapList<Bus>& list, App& app, Scratch& scratch) : list_{&list}, app_{&app}, scratch_{&scratch} {}

    /// The list has been set up: offers the first connection.
    void start(const AcyclicConfig& config, std::uint8_t own_address) {
        config_ = &config;
        own_address_ = own_address;
        baud_code_ = 15;
        offered_ = kNone;
        for (Connection& c : connections_) c.state = C2State::closed;
        offer();
    }
    /// Ends all connections; nobody is left to be told but the application.
    void stop() {
        for (std::uint8_t n = 0; n < count(); ++n) {
            if (connections_[n].state == C2State::closed) continue;
            const bool known = connections_[n].state != C2State::aborting;
            shut(n);
            if (known) app_->connection_closed(sap(n), ClosedBy::offline, {});
        }
    }
    void set_own_address(std::uint8_t address) {
        own_address_ = address;
        for (std::uint8_t n = 0; n < count(); ++n)
            if (connections_[n].state == C2State::closed) list_->lock(channel_of(n), own_address_);
        if (count() != 0 && offered_ == kNone) list_->lock(channel::resource_manager, own_address_);
    }
    /// The Send_Timeout that is offered depends on the rate.
    void set_baud(std::uint8_t code) {
        baud_code_ = code;
        if (offered_ != kNone && !list_->has_request(channel::resource_manager, Buffer::first)) write_offer();
    }

    /// Poll_End_Ind: whose answer was it?
    void serve_poll_end() {
        if (count() == 0) return;
        // With a request that came together with the poll, serve_requests() makes the next offer.
        if (list_->take_response_sent(channel::resource_manager) && offered_ != kNone &&
            !list_->has_request(channel::resource_manager, Buffer::first))
            write_offer();
        for (std::uint8_t n = 0; n < count(); ++n)
            if (list_->take_response_sent(channel_of(n))) answer_sent(n);
    }
    /// FDL_Ind: which request has come?
    void serve_requests() {
        if (count() == 0) return;
        for (std::uint8_t n = 0; n < count(); ++n) {
            serve_request(n, Buffer::first);
            serve_request(n, Buffer::second);
        }
        if (list_->has_request(channel::resource_manager, Buffer::first)) serve_initiate();
    }
    void tick(std::uint32_t ms) {
        for (std::uint8_t n = 0; n < count(); ++n) {
            Connection& c = connections_[n];
            if (c.state == C2State::closed) continue;
            c.left = c.left > ms ? c.left - ms : 0;
            if (c.left != 0) continue;
            // The poll that fetches an answer may have come just now.
            if (list_->take_response_sent(channel_of(n))) answer_sent(n);
            else if (c.state == C2State::aborting) close(n);
            else abort(n, dp::Abort{dp::AbortReason::timeout}, ClosedBy::driver);
        }
    }

    bool complete(const Handle& h, const RecordAnswer& answer, std::span<const std::uint8_t> data) {
        if (wrong_service(h, RelationState::Waiting::initiate)) return false;
        const std::uint8_t n = find(h, RelationState::Waiting::record);
        if (n == kNone || answer.kind == RecordAnswer::Kind::later) return false;
        std::array<std::uint8_t, dp::kRecordHeader> head{};
        list_->peek_request(channel_of(n), Buffer::first, head);
        const auto function = static_cast<dp::AcyclicFunction>(head[0]);
        const std::size_t limit = function == dp::AcyclicFunction::ds_read ? std::min(head[3], config_->ms2_max_data)
                                                                           : config_->ms2_max_data;
        respond(n, reply_to(function, {head[1], head[2], head[3]}, answer, data.first(std::min(data.size(), limit))));
        return true;
    }
    bool complete(const Handle& h, const InitiateAnswer& answer) {
        if (wrong_service(h, RelationState::Waiting::record)) return false;
        const std::uint8_t n = find(h, RelationState::Waiting::initiate);
        if (n == kNone || answer.kind == InitiateAnswer::Kind::later) return false;
        std::array<std::uint8_t, dp::kMaxInitiatePdu> pdu{};  // scratch_ may be in use when the application calls
        if (const auto request = dp::decode_initiate_req(list_->peek_request(channel_of(n), Buffer::first, pdu)))
            conclude(n, *request, answer);
        return true;
    }
    /// Ends a connection from this side.
    bool abort(std::uint8_t sap_number, std::uint8_t reason) {
        const auto n = static_cast<std::uint8_t>(dp::kLastMs2Sap - sap_number);
        if (sap_number > dp::kLastMs2Sap || n >= count()) return false;
        if (connections_[n].state == C2State::closed || connections_[n].state == C2State::aborting) return false;
        abort(n, {dp::AbortSubnet::none, dp::AbortInstance::user, reason}, ClosedBy::user);
        return true;
    }
    C2State state(std::size_t n) const { return n < Connections ? connections_[n].state : C2State::closed; }

private:
    static constexpr std::uint8_t kNone = 0xFF;

    std::uint8_t count() const { return list_->layout().connections; }
    static std::uint8_t channel_of(std::uint8_t n) { return static_cast<std::uint8_t>(channel::connection0 + n); }
    static std::uint8_t sap(std::uint8_t n) { return channel_sap(channel_of(n)); }
    std::uint16_t own_send_timeout() const {
        return std::max(config_->send_timeout, dp::min_send_timeout(baud_code_));
    }
    static std::uint32_t milliseconds(const Connection& c) { return c.send_timeout * dp::kSendTimeoutUnit; }

    /// The connection whose application owes an answer to `h`.
    std::uint8_t find(const Handle& h, RelationState::Waiting waiting) const {
        for (std::uint8_t n = 0; n < count(); ++n) {
            const Connection& c = connections_[n];
            if (c.state == C2State::working && sap(n) == h.sap && c.relation.serial == h.serial && c.relation.waiting == waiting)
                return n;
        }
        return kNone;
    }

    /// The application answers with another service than it was asked for: the connection ends with IV.
    bool wrong_service(const Handle& h, RelationState::Waiting asked) {
        const std::uint8_t n = find(h, asked);
        if (n == kNone) return false;
        abort(n, dp::Abort{dp::AbortReason::invalid_service}, ClosedBy::driver);
        return true;
    }

    // ---- resource manager
    /// Makes the highest free SAP the next one; without any, SAP 49 is closed.
    void offer() {
        if (count() == 0) return;
        for (std::uint8_t n = 0; n < count(); ++n) {
            if (connections_[n].state != C2State::closed) continue;
            offered_ = n;
            write_offer();
            return list_->open(channel::resource_manager, {});
        }
        offered_ = kNone;
        list_->lock(channel::resource_manager, own_address_);
        list_->withdraw_answer(channel::resource_manager);
    }
    void write_offer() {
        std::array<std::uint8_t, dp::kResourceManagerPdu> pdu{};
        static_cast<void>(dp::encode(dp::ResourceManager{sap(offered_), own_send_timeout()}, pdu));
        list_->respond(channel::resource_manager, pdu);
    }
    void serve_initiate() {
        const Requester who = list_->requester(channel::resource_manager);
        const dp::Octets pdu = list_->read_request(channel::resource_manager, Buffer::first, scratch_->request);
        list_->release(channel::resource_manager, Buffer::first);
        if (offered_ == kNone) return;
        const std::uint8_t n = offered_;
        Connection& c = connections_[n];
        c.master = who.master();
        c.send_timeout = dp::agreed_send_timeout(own_send_timeout(), 1);
        c.relation = {.serial = static_cast<std::uint8_t>(c.relation.serial + 1)};
        list_->keep_request(channel_of(n), pdu);
        enter(n, C2State::working);
        list_->open(channel_of(n), who);
        offer();
        initiate(n, pdu);
    }
    void initiate(std::uint8_t n, dp::Octets pdu) {
        Connection& c = connections_[n];
        const auto request = dp::decode_initiate_req(pdu);
        if (!request) {
            const bool short_one = request.error() == dp::AcyclicError::too_short;
            const dp::Abort why{short_one ? dp::AbortReason::invalid_address : dp::AbortReason::invalid_request};
            c.relation.waiting = RelationState::Waiting::none;
            return send_abort(n, why);
        }
        c.send_timeout = dp::agreed_send_timeout(own_send_timeout(), request->send_timeout);
        enter(n, C2State::working);
        const InitiateCall call{{sap(n), c.relation.serial}, c.master, c.send_timeout, *request};
        conclude(n, *request, app_->initiate(call));
    }
    /// The answer's source is this station: the address parts change places.
    void conclude(std::uint8_t n, const dp::InitiateReq& request, const InitiateAnswer& answer) {
        Connection& c = connections_[n];
        c.relation.waiting = RelationState::Waiting::initiate;
        if (answer.kind == InitiateAnswer::Kind::later) return;
        c.relation.waiting = RelationState::Waiting::none;
        if (answer.kind == InitiateAnswer::Kind::refused) return send_abort(n, answer.abort);
        std::array<std::uint8_t, dp::kMaxAcyclicPdu> pdu{};
        const auto length = dp::encode(
            dp::InitiateRes{config_->ms2_max_data, answer.features, request.destination, request.source}, pdu);
        list_->respond(channel_of(n), std::span{pdu}.first(length ? *length : 0));
        enter(n, C2State::responding);
        app_->connection_opened(sap(n), c.master);
    }

    // ---- connections
    void enter(std::uint8_t n, C2State state) {
        Connection& c = connections_[n];
        c.state = state;
        c.left = state == C2State::awaiting ? 2 * milliseconds(c) : milliseconds(c);
    }
    void respond(std::uint8_t n, const Reply& reply) {
        connections_[n].relation.waiting = RelationState::Waiting::none;
        list_->respond(channel_of(n), reply.head_span(), reply.data);
        enter(n, C2State::responding);
    }
    void answer_sent(std::uint8_t n) {
        if (connections_[n].state == C2State::aborting) close(n);
        else if (connections_[n].state == C2State::responding) enter(n, C2State::awaiting);
    }
    void serve_request(std::uint8_t n, Buffer which) {
        const std::uint8_t ch = channel_of(n);
        if (!list_->has_request(ch, which)) return;
        Connection& c = connections_[n];
        const dp::Octets pdu = list_->read_request(ch, which, scratch_->request);
        if (which == Buffer::second) list_->release(ch, which);
        if (c.state == C2State::closed) return list_->release(ch, which);
        if (!pdu.empty() && pdu[0] == core::to_underlying(dp::AcyclicFunction::abort)) return aborted_by_master(n, pdu);
        if (c.state == C2State::aborting) return;
        if (which == Buffer::second || c.state != C2State::awaiting)
            return abort(n, dp::Abort{dp::AbortReason::sequence_error}, ClosedBy::driver);
        serve(n, pdu);
    }
    void serve(std::uint8_t n, dp::Octets pdu) {
        Connection& c = connections_[n];
        if (const auto second = dp::decode_idle(pdu)) {
            std::array<std::uint8_t, dp::kIdlePdu> echo{};
            static_cast<void>(dp::encode_idle(*second, echo));
            list_->respond(channel_of(n), echo);
            return enter(n, C2State::responding);
        }
        if (!is_record_request(pdu)) return abort(n, dp::Abort{dp::AbortReason::invalid_request}, ClosedBy::driver);
        c.relation.serial = static_cast<std::uint8_t>(c.relation.serial + 1);
        enter(n, C2State::working);
        RecordService<App> service{*app_, c.relation, config_->ms2_max_data, config_->identification, scratch_->answer};
        const Reply reply = service.serve({.handle = {sap(n), c.relation.serial}, .relation = Relation::ms2, .master = c.master}, pdu);
        if (c.state == C2State::working && !reply.later) respond(n, reply);
    }
    static bool is_record_request(dp::Octets pdu) {
        if (pdu.empty()) return false;
        const auto f = static_cast<dp::AcyclicFunction>(pdu[0]);
        return f == dp::AcyclicFunction::ds_read || f == dp::AcyclicFunction::ds_write || f == dp::AcyclicFunction::data_transport;
    }

    // ---- the end
    void aborted_by_master(std::uint8_t n, dp::Octets pdu) {
        const auto why = dp::decode_abort(pdu);
        const bool known = connections_[n].state != C2State::aborting;
        drop_request(n);
        close(n);
        if (known) app_->connection_closed(sap(n), ClosedBy::master, why ? *why : dp::Abort{});
    }
    void abort(std::uint8_t n, const dp::Abort& why, ClosedBy by) {
        drop_request(n);
        send_abort(n, why);
        app_->connection_closed(sap(n), by, why);
    }
    void send_abort(std::uint8_t n, const dp::Abort& why) {
        std::array<std::uint8_t, dp::kAbortPdu> pdu{};
        static_cast<void>(dp::encode(why, pdu));
        list_->respond(channel_of(n), pdu);
        enter(n, C2State::aborting);
    }
    void drop_request(std::uint8_t n) {
        RelationState& r = connections_[n].relation;
        const bool waiting = r.waiting != RelationState::Waiting::none;
        r.waiting = RelationState::Waiting::none;
        if (waiting) app_->request_dropped({sap(n), r.serial});
    }
    /// The SAP is locked before its buffers are taken away.
    void shut(std::uint8_t n) {
        const std::uint8_t ch = channel_of(n);
        list_->lock(ch, own_address_);
        list_->release(ch, Buffer::first);
        list_->release(ch, Buffer::second);
        list_->take_response_sent(ch);
        connections_[n].state = C2State::closed;
        connections_[n].relation.waiting = RelationState::Waiting::none;
    }
    void close(std::uint8_t n) {
        shut(n);
        if (offered_ == kNone) offer();
    }

    SapList<Bus>* list_;
    App* app_;
    Scratch* scratch_;
    const AcyclicConfig* config_ = nullptr;
    std::array<Connection, Connections> connections_{};
    std::uint8_t offered_ = kNone;
    std::uint8_t own_address_ = 126, baud_code_ = 15;
};

}  // namespace dpchip::driver::detail
