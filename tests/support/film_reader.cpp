#include "tests/support/film_reader.hpp"

#include <algorithm>
#include <stdexcept>

namespace grainsweep::tests {
namespace {

class Bits {
public:
    explicit Bits(std::string_view bytes) : bytes_(bytes) {}
    std::uint32_t take(unsigned count) {
        std::uint32_t value = 0;
        for (unsigned b = 0; b < count; ++b, ++at_) {
            if (at_ / 8 >= bytes_.size()) throw std::out_of_range("a column ends too early");
            value |= (static_cast<unsigned char>(bytes_[at_ / 8]) >> at_ % 8 & 1U) << b;
        }
        return value;
    }
    [[nodiscard]] std::size_t bytes_used() const { return (at_ + 7) / 8; }

private:
    std::string_view bytes_;
    std::size_t at_ = 0;
};

std::vector<std::uint16_t> unpack(Bits& bits, std::size_t frames, std::size_t items) {
    std::vector<std::uint16_t> values(frames * items);
    for (std::size_t f = 0; f < frames; ++f) {
        const std::uint32_t way = bits.take(2);
        std::uint32_t k = 0;
        for (std::size_t i = 0; i < items; ++i) {
            if (i % 32 == 0) k = bits.take(5);
            std::uint32_t z = 0;
            if (k != 31) {
                std::uint32_t zeros = 0;
                while (bits.take(1) == 0) ++zeros;
                z = zeros < 24 ? zeros << k | bits.take(k) : bits.take(17);
            }
            const std::int32_t rest =
                z % 2 == 0 ? static_cast<std::int32_t>(z / 2) : -static_cast<std::int32_t>((z + 1) / 2);
            const std::size_t at = f * items + i;
            std::int32_t expected = 0;
            if (way == 0 && i > 0) expected = values[at - 1];
            if (way == 1) expected = values.at(at - items);
            if (way == 2) expected = std::clamp(2 * values.at(at - items) - values.at(at - 2 * items), 0, 65535);
            values[at] = static_cast<std::uint16_t>(expected + rest);
        }
    }
    return values;
}

}  // namespace

std::vector<std::uint16_t> unpack_film_column(std::string_view bytes, std::size_t frames, std::size_t items) {
    Bits bits(bytes);
    return unpack(bits, frames, items);
}

std::vector<std::uint16_t> ReadFilm::column(const nlohmann::json& place, std::size_t frames, std::size_t items) const {
    const auto length = place.at(1).get<std::size_t>();
    Bits bits(std::string_view(blocks).substr(place.at(0).get<std::size_t>(), length));
    auto values = unpack(bits, frames, items);
    if (bits.bytes_used() != length) throw std::runtime_error("a block is longer than its column");
    return values;
}

ReadFilm read_film(const std::string& bytes) {
    if (!bytes.starts_with("GSF1")) throw std::runtime_error("this is no film");
    std::size_t length = 0;
    for (std::size_t k = 0; k < 4; ++k)
        length |= static_cast<std::size_t>(static_cast<unsigned char>(bytes.at(4 + k))) << 8 * k;
    return {nlohmann::json::parse(bytes.substr(8, length)), bytes.substr(8 + length)};
}

}  // namespace grainsweep::tests
