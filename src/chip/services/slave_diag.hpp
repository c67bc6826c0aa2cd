// SPDX-License-Identifier: Apache-2.0
// Slave_Diag, SAP 60 (6.2.4; reference 3.7): any master may read, in every state. The answer is composed by the transmitter.
#pragma once

#include <dpchip/chip/dp_sm.hpp>
#include <dpchip/chip/mac.hpp>

namespace dpchip::chip::slave_diag {

template <class C>
Answer serve(C&) { return Answer::slave_diag; }

/// The diagnosis has been sent: Diag_Flag goes out when its reader was the owner, unless Stat_Diag keeps it.
template <class C>
void sent(C& c) {
    const bool reader_counts = c.s.owner == dp::kNoMaster || c.s.owner == mac::master(c.s);
    if (reader_counts && (c.s.diag_control & diag::kStatDiag) == 0) diag::set_flag(c, false);
    diag::end_sending(c);
}

}  // namespace dpchip::chip::slave_diag
