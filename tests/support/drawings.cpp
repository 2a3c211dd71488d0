#include "tests/support/drawings.hpp"

#include <zlib.h>

#include <cstdint>
#include <stdexcept>
#include <string>
#include <string_view>

namespace grainsweep::tests {
namespace {

std::string from_base64(std::string_view text) {
    constexpr std::string_view digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string bytes;
    std::uint32_t word = 0;
    int bits = 0;
    for (const char c : text) {
        if (c == '=') break;
        word = word << 6U | static_cast<std::uint32_t>(digits.find(c));
        if ((bits += 6) < 8) continue;
        bits -= 8;
        bytes += static_cast<char>(word >> static_cast<unsigned>(bits) & 0xFFU);
    }
    return bytes;
}

}  // namespace

nlohmann::ordered_json drawings_of(const nlohmann::ordered_json& campaign) {
    const auto packed = from_base64(campaign.at("figures").get<std::string>());
    std::string text(std::size_t{32} << 20U, '\0');
    uLongf length = text.size();
    if (uncompress(reinterpret_cast<Bytef*>(text.data()), &length, reinterpret_cast<const Bytef*>(packed.data()),
                   packed.size()) != Z_OK)
        throw std::runtime_error("the figures of a page cannot be unpacked");
    text.resize(length);
    return nlohmann::ordered_json::parse(text);
}

}  // namespace grainsweep::tests
