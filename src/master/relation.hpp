// SPDX-License-Identifier: Apache-2.0
// An acyclic relation to one slave: one service at a time, sent and polled for in the acyclic part of the master's
// cycle (reference 5.3, 5.4). Ms1 and Ms2 are its two kinds; Master::attach() makes it take its turns.
//
// A relation is a state machine that is asked for its next job and told what became of it. It allocates nothing.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include <dpchip/core/ticks.hpp>
#include <dpchip/dp/acyclic.hpp>
#include <dpchip/master/job.hpp>
#include <dpchip/master/service_result.hpp>

namespace dpchip::master {

using core::Ticks;

struct RelationCounters {
    std::uint64_t services = 0;   ///< begun
    std::uint64_t done = 0;       ///< of these, answered positively
    std::uint64_t refused = 0;    ///< of these, answered negatively
    std::uint64_t polls = 0;
    std::uint64_t busy = 0;       ///< requests and polls put off by RR or RS and tried again
    std::uint64_t stale = 0;      ///< answers thrown away because nobody waited for them any more
};

class Relation {
public:
    virtual ~Relation() = default;
    Relation(const Relation&) = delete;  // a master holds its address
    Relation& operator=(const Relation&) = delete;

    // ---- services: false when one is under way. What cannot be asked ends at once: see result(). -----------------
    /// DS_Read of up to `length` octets, 1..240.
    bool read(std::uint8_t slot, std::uint8_t index, std::size_t length = dp::kMaxRecord);
    /// DS_Write of 1..240 octets.
    bool write(std::uint8_t slot, std::uint8_t index, std::span<const std::uint8_t> data);

    /// Of the last service.
    const ServiceResult& result() const { return result_; }
    bool busy() const { return result_.pending(); }
    /// After a read or a transport that was done: the record. Valid until the next service.
    std::span<const std::uint8_t> data() const;
    /// After a write that was done: octets the slave took.
    std::uint8_t accepted() const { return accepted_; }
    std::uint8_t address() const { return address_; }
    const RelationCounters& counters() const { return counters_; }

    // ---- for the master -----------------------------------------------------------------------------------------
    /// The next request, or null when there is nothing to ask at `now`. It stays untouched until job_done().
    virtual Job* next_job(Ticks now) = 0;
    virtual void job_done(Ticks now) = 0;

protected:
    explicit Relation(std::uint8_t address) : address_{address} {}

    /// Begins a service with the PDU of `octets` in request_; an error ends it at once.
    bool begin(const dp::AcyclicResult<std::size_t>& octets);
    /// Whether a service may begin now; `why` when not.
    virtual bool usable(ServiceResult& why) const = 0;
    virtual void begun() = 0;
    virtual std::size_t max_data() const { return dp::kMaxRecord; }

    std::span<const std::uint8_t> request() const { return std::span{request_}.first(request_size_); }
    /// Judges an answer PDU to the request: done, refused or bad_answer.
    ServiceResult judge(std::span<const std::uint8_t> pdu);
    void finish(const ServiceResult& result);
    Job& ask(std::uint8_t dsap, std::uint8_t ssap, std::span<const std::uint8_t> pdu);

    Job job_{};
    std::array<std::uint8_t, dp::kMaxAcyclicPdu> request_{};
    RelationCounters counters_{};

private:
    std::uint8_t address_;
    ServiceResult result_{};
    std::size_t request_size_ = 0;
    std::array<std::uint8_t, dp::kMaxRecord> data_{};
    std::size_t data_size_ = 0;
    std::uint8_t accepted_ = 0;
};

}  // namespace dpchip::master
