// SPDX-License-Identifier: Apache-2.0
// Telegrams in words (reference 2, 3): one line for a list, more lines for who wants to know every octet.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <dpchip/dp/saps.hpp>
#include <dpchip/fdl/telegram.hpp>

namespace dpchip::trace {

/// Texts that only a device's GSD knows, by station. Empty where there are none. GsdTexts is one.
class DeviceTexts {
public:
    virtual ~DeviceTexts() = default;
    /// What the device-related diagnosis block of `station` says; `data` is what stands behind its header octet.
    virtual std::vector<std::string> device_diag(std::uint8_t station, std::span<const std::uint8_t> data) const = 0;
    /// Error 16..31 of a channel-related diagnosis.
    virtual std::string channel_error(std::uint8_t station, std::uint8_t error) const = 0;
    /// Whether the station is a DP-V1 slave, whose device-related blocks are alarms and status messages. Nothing: unknown.
    virtual std::optional<bool> dpv1_slave(std::uint8_t /*station*/) const { return std::nullopt; }
};

/// The request that an answer belongs to.
struct Request {
    bool known{};
    std::uint8_t da{}, sa{};  ///< without extension bits
    fdl::Request function{};
    dp::Service service = dp::Service::none;
    std::uint8_t dsap = dp::kDefaultSap;
};

/// What is known besides the octets.
struct Context {
    Request request{};                    ///< for answers
    bool repeated{};                      ///< the frame count bit says: a repetition
    const DeviceTexts* texts = nullptr;   ///< may be null
};

/// A telegram in words. No line ends in a newline.
struct Explanation {
    std::string line;                  ///< "SD2 2->8 SRD high FCB=1 Set_Prm Lock_Req WD_On, WD 100 ms, ident 4711H"
    std::vector<std::string> details;  ///< octet by octet
};

/// Explains one good telegram.
Explanation explain(const fdl::Telegram& telegram, const Context& context = {});

/// Explains octets that are no telegram: the reason in words and the octets.
Explanation explain_reject(fdl::Reject reason, std::span<const std::uint8_t> octets);

/// The service a request asks for. Data_Exchange for SRD without DSAP; none for SDA, FDL_Status, token and answers.
dp::Service requested_service(const fdl::Telegram& telegram);

/// What `telegram` is as a request; `known` is false for answers, tokens and requests that get no answer.
Request request_of(const fdl::Telegram& telegram);

/// True when `telegram` can be the answer to `request`.
bool answers(const fdl::Telegram& telegram, const Request& request);

}  // namespace dpchip::trace
