// SPDX-License-Identifier: Apache-2.0
// MS2: a connection of a class-2 master, from Initiate on SAP 49 to Abort (reference 5.4). It needs no data exchange:
// any master may open one, also for slaves that belong to another.
//
// While nothing is asked, Idle keeps the connection alive. When the slave ends it, or falls silent, ending() says why;
// open() opens it again.
#pragma once

#include <array>
#include <cstdint>

#include <dpchip/dp/initiate.hpp>
#include <dpchip/master/relation.hpp>

namespace dpchip::master {

struct Ms2Config {
    std::uint8_t address{};                       ///< the slave's
    std::uint16_t send_timeout = 1;               ///< asked for, 10 ms; the slave's least one holds when it is longer
    std::uint16_t longest_send_timeout = 0;       ///< a slave that wants more is told STO, and there is no connection; 0: any
    dp::InitiateFeatures features{};
    std::array<std::uint8_t, 2> source{};         ///< API and SCL of this end
    std::array<std::uint8_t, 2> destination{};    ///< API and SCL of the other end
    Ticks response_timeout{};                     ///< from a request to its answer; 0: three times Send_Timeout
    Ticks poll_interval{};                        ///< least time between two polls
    Ticks settle = core::milliseconds(3);         ///< what slaves need to open the SAP that SAP 49 has named
    Ticks patience = core::milliseconds(100);     ///< how long RS and RR of a busy resource manager are not taken for a no
    bool keep_alive = true;                       ///< send Idle
};

enum class Ms2State : std::uint8_t {
    closed,
    initiating,   ///< Initiate.req is on its way to SAP 49, or its answer is
    connecting,   ///< polls for Initiate.res
    open,         ///< nothing is asked
    requesting,   ///< a request is to be sent
    polling,      ///< for its answer
    idle_request, ///< Idle is to be sent
    idle_polling,
    aborting,     ///< Abort is to be sent
};
const char* name(Ms2State state);

class Ms2 : public Relation {
public:
    explicit Ms2(const Ms2Config& config) : Relation{config.address}, config_{config} {}

    /// Opens the connection: a service like others, see result(). False when it is open, or a service is under way. While
    /// an Abort waits for its confirmation it ends at once: reason OC.
    bool open();
    /// Data_Transport of 0..240 octets; data() is what comes back.
    bool transport(std::uint8_t slot, std::uint8_t index, std::span<const std::uint8_t> data);
    /// Ends the connection with an Abort of instance user, as soon as a request under way is answered by SC or data. A
    /// service that waits for its answer ends with Kind::ended.
    void close(std::uint8_t reason = 0);

    Ms2State state() const { return state_; }
    bool is_open() const { return state_ >= Ms2State::open && state_ <= Ms2State::idle_polling && !closing_; }
    /// Why it was closed last; none while it never was.
    const ServiceResult& ending() const { return ending_; }
    /// Of the open connection: its SAP, Send_Timeout in 10 ms, longest record, the slave's features.
    std::uint8_t sap() const { return sap_; }
    std::uint16_t send_timeout() const { return send_timeout_; }
    std::uint8_t max_length() const { return max_length_; }
    const dp::InitiateFeatures& features() const { return features_; }
    std::uint64_t idles() const { return idles_; }

    Job* next_job(Ticks now) override;
    void job_done(Ticks now) override;

private:
    bool usable(ServiceResult& why) const override;
    void begun() override { wanted_ = true; }
    std::size_t max_data() const override { return max_length_; }

    void enter(Ms2State state, Ticks now);
    bool expired(Ticks now) const { return now >= deadline_; }
    void give_up(Ticks now);
    void put_off(Ticks now);
    void refused(Ticks now);
    void acknowledged(Ticks now);
    void take_data(Ticks now);
    void initiated(std::span<const std::uint8_t> pdu, Ticks now);
    void connected(std::span<const std::uint8_t> pdu, Ticks now);
    void break_off(const dp::Abort& abort, const ServiceResult& why, Ticks now);
    void shut(const ServiceResult& why);
    Ticks send_timeout_ticks() const { return core::milliseconds(send_timeout_ * dp::kSendTimeoutUnit); }
    std::span<const std::uint8_t> initiate_pdu() { return std::span{initiate_}.first(initiate_size_); }

    Ms2Config config_;
    Ms2State state_ = Ms2State::closed;
    bool wanted_ = false;        ///< a service waits for its turn
    bool closing_ = false;       ///< the user wants to close
    bool rm_poll_ = false;       ///< SAP 49 took the Initiate.req without naming a SAP: ask for it
    bool draining_ = false;      ///< the request was answered RR: fetch what is in the way
    dp::Abort abort_{};          ///< to be sent
    ServiceResult ending_{};
    ServiceResult after_abort_{};
    std::uint8_t sap_ = dp::kSapResourceManager;
    std::uint8_t max_length_ = dp::kMaxRecord;
    std::uint16_t send_timeout_ = 0;
    dp::InitiateFeatures features_{};
    std::array<std::uint8_t, dp::kMinInitiateReq> initiate_{};
    std::size_t initiate_size_ = 0;
    std::uint64_t idles_ = 0;
    Ticks again_{};       ///< not before
    Ticks deadline_{};    ///< of the present state
    Ticks patient_until_{};
    Ticks last_sent_{};   ///< last request or answer on an open connection
};

}  // namespace dpchip::master
