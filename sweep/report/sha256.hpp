// SHA-256 (FIPS 180-4), for the scripts in a page's content security policy.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

namespace grainsweep::report {

[[nodiscard]] std::array<std::uint8_t, 32> sha256(std::string_view text);

}  // namespace grainsweep::report
