#include "tests/support/film_reader.hpp"

#include <zlib.h>

#include <stdexcept>

namespace grainsweep::tests {

std::vector<std::uint16_t> unpack_film_column(std::string_view packed, std::size_t frames, std::size_t items) {
    const std::size_t count = frames * items;
    std::vector<unsigned char> bytes(2 * count + 1);
    uLongf length = bytes.size();
    if (uncompress(bytes.data(), &length, reinterpret_cast<const Bytef*>(packed.data()), packed.size()) != Z_OK ||
        length != 2 * count)
        throw std::runtime_error("a block is not its column");
    std::vector<std::uint16_t> values(count);
    for (std::size_t at = 0; at < count; ++at) {
        const int z = bytes[at] + 256 * bytes[count + at];
        const int rest = z % 2 == 0 ? z / 2 : -(z + 1) / 2;
        const int before = at >= items ? values[at - items] : at > 0 ? values[at - 1] : 0;
        values[at] = static_cast<std::uint16_t>(before + rest);
    }
    return values;
}

std::vector<std::uint16_t> ReadFilm::column(const nlohmann::json& number, std::size_t frames, std::size_t items) const {
    const auto block = number.get<std::size_t>();
    std::size_t begin = 0;
    for (std::size_t k = 0; k < block; ++k) begin += header.at("blocks").at(k).get<std::size_t>();
    return unpack_film_column(std::string_view(blocks).substr(begin, header.at("blocks").at(block)), frames, items);
}

ReadFilm read_film(const std::string& bytes) {
    if (!bytes.starts_with("GSF2")) throw std::runtime_error("this is no film");
    std::size_t length = 0;
    for (std::size_t k = 0; k < 4; ++k)
        length |= static_cast<std::size_t>(static_cast<unsigned char>(bytes.at(4 + k))) << 8 * k;
    return {nlohmann::json::parse(bytes.substr(8, length)), bytes.substr(8 + length)};
}

}  // namespace grainsweep::tests
