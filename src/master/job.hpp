// SPDX-License-Identifier: Apache-2.0
// An acyclic request: one question to one station, asked after the cyclic part of a cycle. The owner keeps the Job and
// watches finished(); the master fills it in.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include <dpchip/dp/saps.hpp>
#include <dpchip/dp/set_slave_add.hpp>
#include <dpchip/fdl/function_code.hpp>
#include <dpchip/fdl/telegram.hpp>

namespace dpchip::master {

struct Job {
    enum class Outcome : std::uint8_t {
        idle,           ///< never given to a master, or taken back
        waiting,        ///< its turn has not come, or its answer has not
        data,           ///< answered with data
        acknowledged,   ///< answered with SC, or FDL_Status answered
        refused,        ///< answered without data: RS, RR, UE ... see `response`
        unanswered,     ///< no answer, not even after the last retry
    };

    std::uint8_t address{};
    fdl::Request function = fdl::Request::srd_high;
    std::uint8_t dsap = dp::kDefaultSap;             ///< dp::kDefaultSap: without SAP octets
    std::uint8_t ssap = dp::kMasterSap;
    std::array<std::uint8_t, 244> request{};
    std::uint16_t request_size = 0;

    Outcome outcome = Outcome::idle;
    fdl::FunctionCode response{};                    ///< FC of the answer; none for SC
    std::array<std::uint8_t, fdl::kMaxDataUnit> answer{};
    std::uint16_t answer_size = 0;

    bool finished() const { return outcome > Outcome::waiting; }
    bool good() const { return outcome == Outcome::data || outcome == Outcome::acknowledged; }
    std::span<const std::uint8_t> data() const { return std::span{answer}.first(answer_size); }

    static Job fdl_status(std::uint8_t address) {
        Job job{};
        job.address = address;
        job.function = fdl::Request::fdl_status;
        return job;
    }
    static Job slave_diag(std::uint8_t address) { return service(address, dp::kSapSlaveDiag); }
    static Job get_cfg(std::uint8_t address) { return service(address, dp::kSapGetCfg); }
    static Job rd_input(std::uint8_t address) { return service(address, dp::kSapRdInput); }
    static Job rd_output(std::uint8_t address) { return service(address, dp::kSapRdOutput); }
    /// Data beyond 244 octets are cut.
    static Job set_slave_add(std::uint8_t address, const dp::SetSlaveAdd& change) {
        Job job = service(address, dp::kSapSetSlaveAdd);
        const auto size = dp::encode(change, job.request);
        job.request_size = static_cast<std::uint16_t>(size ? *size : 0);
        return job;
    }
    static Job service(std::uint8_t address, std::uint8_t dsap, std::span<const std::uint8_t> data = {}) {
        Job job{};
        job.address = address;
        job.dsap = dsap;
        job.request_size = static_cast<std::uint16_t>(std::min(data.size(), job.request.size()));
        std::copy_n(data.begin(), job.request_size, job.request.begin());
        return job;
    }
};
const char* name(Job::Outcome outcome);

/// What a scan of the bus found at one address.
struct Found {
    bool present = false;
    fdl::StationType type{};
    bool diagnosed = false;           ///< a slave that answered Slave_Diag
    std::uint16_t ident = 0;
    std::uint8_t master_add = 0xFF;   ///< who owns it
};

}  // namespace dpchip::master
