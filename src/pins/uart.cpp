// SPDX-License-Identifier: Apache-2.0
// The UART's code for both kinds of chip, compiled once.
#include <dpchip/pins/uart.hpp>

namespace dpchip::pins {

template class BasicUart<chip::Chip<core::NoTrace>>;
template class BasicUart<chip::Chip<core::RingTrace>>;

}  // namespace dpchip::pins
