// SPDX-License-Identifier: Apache-2.0
// One half of a redundant slave: what its masters command by PrmCmd, and the status messages that answer (reference 6.4).
// A basic state: which half is primary. The outputs and the talk with the other half are the application's.
#pragma once

#include <cstdint>

#include <dpchip/dp/redundancy.hpp>

namespace dpchip::driver {

enum class Role : std::uint8_t { none, backup, primary };

class RedundantHalf {
public:
    Role role() const { return role_; }
    /// Obeys; the answer is the acknowledgement for the diagnosis.
    dp::RedStatus command(const dp::PrmCmd& c) {
        if (c.primary_request) role_ = Role::primary;
        if (c.backup_request) role_ = Role::backup;
        master_state_clear_ = c.master_state_clear;
        return {.acknowledges = true, .seq_nr = c.seq_nr, .function = dp::function(c), .red_state_1 = state(), .red_state_2 = other_};
    }
    /// What the half tells by itself when something has changed.
    dp::RedStatus status() const { return {.red_state_1 = state(), .red_state_2 = other_}; }

    void set_data_exchange(bool on) { data_exchange_ = on; }
    void set_baud_found(bool on) { baud_found_ = on; }
    void set_hw_defect(bool on) { hw_defect_ = on; }
    /// RedState of the other half, as that one said.
    void set_other(std::uint8_t red_state) { other_ = red_state; }
    std::uint8_t state() const {
        return static_cast<std::uint8_t>((role_ == Role::backup ? dp::kRedBackup : 0u) | (role_ == Role::primary ? dp::kRedPrimary : 0u) |
                                         (hw_defect_ ? dp::kRedHwDefect : 0u) | (data_exchange_ ? dp::kRedDataExchange : 0u) |
                                         (master_state_clear_ ? dp::kRedMasterStateClear : 0u) | (baud_found_ ? dp::kRedBaudrateFound : 0u));
    }

private:
    Role role_ = Role::none;
    bool master_state_clear_ = false, data_exchange_ = false, baud_found_ = false, hw_defect_ = false;
    std::uint8_t other_ = 0;
};

}  // namespace dpchip::driver
