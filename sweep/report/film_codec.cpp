#include "sweep/report/film_codec.hpp"

#include <zlib.h>

#include <stdexcept>
#include <vector>

namespace grainsweep::report {

std::string pack_film_column(std::span<const std::uint16_t> values, std::size_t items) {
    const std::size_t n = values.size();
    if (n > 0 && (items == 0 || n % items != 0))
        throw std::invalid_argument("a column of a film is no whole number of frames");
    std::vector<unsigned char> bytes(2 * n);
    for (std::size_t i = 0; i < n; ++i) {
        const int expected = i >= items ? values[i - items] : i > 0 ? values[i - 1] : 0;
        const auto rest = static_cast<std::int16_t>(values[i] - expected);
        const unsigned folded = rest >= 0 ? 2U * static_cast<unsigned>(rest) : static_cast<unsigned>(-2 * rest - 1);
        bytes[i] = static_cast<unsigned char>(folded & 0xFFU);
        bytes[n + i] = static_cast<unsigned char>(folded >> 8U);
    }
    uLongf length = compressBound(bytes.size());
    std::string packed(length, '\0');
    if (compress2(reinterpret_cast<Bytef*>(packed.data()), &length, bytes.data(), bytes.size(), Z_BEST_COMPRESSION) !=
        Z_OK)
        throw std::runtime_error("zlib cannot pack a column of a film");
    packed.resize(length);
    return packed;
}

}  // namespace grainsweep::report
