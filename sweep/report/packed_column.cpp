#include "sweep/report/packed_column.hpp"

#include <zlib.h>

#include <algorithm>
#include <bit>
#include <charconv>
#include <cmath>
#include <concepts>
#include <limits>
#include <map>
#include <optional>
#include <stdexcept>
#include <utility>

namespace grainsweep::report {
namespace {

constexpr std::size_t most_different = 256;
constexpr double exact_in_float = 16'777'216;  // 2^24

/// Little-endian.
template <std::unsigned_integral Word>
void append(std::string& bytes, Word word) {
    for (std::size_t k = 0; k < sizeof word; ++k) bytes += static_cast<char>(word >> (8 * k) & 0xFFU);
}

/// Returns the different values in their order of occurrence, and an index into them for each value; empty if there are
/// too many.
template <class T>
std::optional<std::pair<std::vector<T>, std::string>> dictionary(std::span<const T> values) {
    std::map<T, char> places;
    std::pair<std::vector<T>, std::string> found;
    for (const T& value : values) {
        const auto [place, is_new] = places.try_emplace(value, static_cast<char>(places.size()));
        if (places.size() > most_different) return std::nullopt;
        if (is_new) found.first.push_back(value);
        found.second += place->second;
    }
    return found;
}

}  // namespace

std::string base64(std::string_view bytes) {
    static constexpr std::string_view digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    text.reserve((bytes.size() + 2) / 3 * 4);
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        const std::size_t there = std::min<std::size_t>(3, bytes.size() - i);
        std::uint32_t word = 0;
        for (std::size_t k = 0; k < 3; ++k)
            word = word << 8 | (k < there ? static_cast<unsigned char>(bytes[i + k]) : 0U);
        for (std::size_t k = 0; k < 4; ++k) text += k <= there ? digits[word >> (18 - 6 * k) & 63U] : '=';
    }
    return text;
}

std::string deflated(std::string_view bytes) {
    uLongf length = compressBound(bytes.size());
    std::string packed(length, '\0');
    if (compress2(reinterpret_cast<Bytef*>(packed.data()), &length, reinterpret_cast<const Bytef*>(bytes.data()),
                  bytes.size(), Z_BEST_COMPRESSION) != Z_OK)
        throw std::runtime_error("zlib cannot pack a part of a page");
    packed.resize(length);
    return packed;
}

std::string pack_film_column(std::span<const std::uint16_t> values, std::size_t items) {
    const std::size_t n = values.size();
    if (n > 0 && (items == 0 || n % items != 0))
        throw std::invalid_argument("a column of a film is no whole number of frames");
    std::string bytes(2 * n, '\0');
    for (std::size_t i = 0; i < n; ++i) {
        const int expected = i >= items ? values[i - items] : i > 0 ? values[i - 1] : 0;
        const auto rest = static_cast<std::int16_t>(values[i] - expected);
        const unsigned folded = rest >= 0 ? 2U * static_cast<unsigned>(rest) : static_cast<unsigned>(-2 * rest - 1);
        bytes[i] = static_cast<char>(folded & 0xFFU);
        bytes[n + i] = static_cast<char>(folded >> 8U);
    }
    return deflated(bytes);
}

Json packed(std::span<const double> values) {
    std::vector<double> keys;  // NaN, unequal to itself, as an infinity, which no column holds
    for (const double x : values) keys.push_back(std::isfinite(x) ? x : HUGE_VAL);
    if (const auto found = dictionary<double>(keys)) return {{"of", found->first}, {"u8", base64(found->second)}};
    const bool wide = std::ranges::any_of(values, [](double x) {
        const double size = std::abs(x);
        return (size > exact_in_float && x == std::floor(x)) ||
               (size > 0 && size < std::numeric_limits<float>::min()) ||
               (std::isfinite(x) && size > std::numeric_limits<float>::max());
    });
    std::string bytes;
    for (const double x : values) {
        if (wide)
            append(bytes, std::bit_cast<std::uint64_t>(x));
        else
            append(bytes, std::bit_cast<std::uint32_t>(static_cast<float>(x)));
    }
    return {{wide ? "f64" : "f32", base64(bytes)}};
}

Json packed(std::span<const std::int64_t> values) {
    const std::vector<double> numbers(values.begin(), values.end());
    return packed(std::span<const double>(numbers));
}

Json packed(std::span<const std::string> words) {
    const auto found = dictionary<std::string>(words);
    if (!found) throw std::length_error("more than 256 different words in a column");
    return {{"of", found->first}, {"u8", base64(found->second)}};
}

std::string packed_ids(std::span<const std::string> ids) {
    std::string bytes;
    for (const auto& id : ids) {
        if (id.size() != 32) throw std::invalid_argument("'" + id + "' is no case id");
        for (std::size_t k = 0; k < 32; k += 2) {
            std::uint8_t byte = 0;
            const auto [end, error] = std::from_chars(id.data() + k, id.data() + k + 2, byte, 16);
            if (error != std::errc{} || end != id.data() + k + 2)
                throw std::invalid_argument("'" + id + "' is no case id");
            bytes += static_cast<char>(byte);
        }
    }
    return base64(bytes);
}

}  // namespace grainsweep::report
