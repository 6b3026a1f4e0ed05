// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hone/core/pass/value.h"

#include <string>

namespace hone {

/// Why an output that a plug-in's pass wrote cannot be used; "" if it can. Looked at is what other
/// passes rely on without a test of their own: numbers are finite and in the range of a type that
/// has one; pixels of PixelList, RequestList and Samples are in the frame; hits are in the scene.
///
/// `scene`: what Hits are of; may be null for other types.
[[nodiscard]] std::string whyNotUsable(const Value& output, uvec2 extent, const Scene* scene);

} // namespace hone
