#include "sweep/report/vtk_series.hpp"

#include "sweep/store/aside_file.hpp"
#include "sweep/store/broken_world.hpp"

#include <fmt/format.h>

#include <array>
#include <bit>
#include <cstddef>
#include <limits>
#include <span>
#include <stdexcept>
#include <system_error>

namespace grainsweep::report {
namespace {

static_assert(std::endian::native == std::endian::little, "columns are written as they lie in memory");

/// The appended section: blocks one after the other, known by their offset.
class Appended {
public:
    template <class T>
    std::size_t add(std::span<const T> values) {
        const std::size_t offset = bytes_.size();
        const std::uint64_t length = values.size_bytes();
        append(&length, sizeof length);
        append(values.data(), values.size_bytes());
        return offset;
    }
    [[nodiscard]] const std::string& bytes() const { return bytes_; }

private:
    void append(const void* from, std::size_t size) { bytes_.append(static_cast<const char*>(from), size); }
    std::string bytes_;
};

void require_length(const std::string& name, std::size_t found, std::size_t expected) {
    if (found != expected)
        throw std::invalid_argument(
            fmt::format("column '{}' of a picture has {} values for {} particles", name, found, expected));
}

std::string array(std::string_view type, std::string_view name, int components, std::size_t offset) {
    return fmt::format(R"(<DataArray type="{}" Name="{}" NumberOfComponents="{}" format="appended" offset="{}"/>)"
                       "\n",
                       type, name, components, offset);
}

std::string column(Appended& appended, const std::string& name, std::span<const double> values) {
    std::vector<float> single;
    single.reserve(values.size());
    for (const double x : values) single.push_back(static_cast<float>(x));
    return array("Float32", name, 1, appended.add(std::span<const float>(single)));
}

std::string column(Appended& appended, const std::string& name, std::span<const std::array<double, 3>> values) {
    std::vector<float> single;
    single.reserve(3 * values.size());
    for (const auto& v : values)
        for (const double x : v) single.push_back(static_cast<float>(x));
    return array("Float32", name, 3, appended.add(std::span<const float>(single)));
}

/// One cell whose corners are all particles.
std::string all_in_one_cell(Appended& appended, std::size_t particles) {
    std::vector<std::int64_t> corners(particles);
    for (std::size_t i = 0; i < particles; ++i) corners[i] = static_cast<std::int64_t>(i);
    const std::array<std::int64_t, 1> end{static_cast<std::int64_t>(particles)};
    return "<Verts>\n" + array("Int64", "connectivity", 1, appended.add(std::span<const std::int64_t>(corners))) +
           array("Int64", "offsets", 1, appended.add(std::span<const std::int64_t>(end))) + "</Verts>\n";
}

void write(const std::filesystem::path& path, const std::string& bytes) {
    store::AsideFile file(path);
    file.write(std::as_bytes(std::span(bytes)));
    file.take_place();
}

}  // namespace

std::string vtp(const Snapshot& snapshot, double time) {
    const std::size_t n = snapshot.positions.size();
    if (n > static_cast<std::size_t>(std::numeric_limits<std::int32_t>::max()))
        throw std::invalid_argument("a picture holds too many particles");
    Appended appended;
    std::string points = column(appended, "Points", snapshot.positions);
    std::string columns;
    for (const auto& [name, values] : snapshot.scalars) {
        require_length(name, values.size(), n);
        columns += column(appended, name, values);
    }
    for (const auto& [name, values] : snapshot.vectors) {
        require_length(name, values.size(), n);
        columns += column(appended, name, values);
    }
    const std::string cell = all_in_one_cell(appended, n);
    std::string text =
        "<?xml version=\"1.0\"?>\n"
        "<VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\">\n"
        "<PolyData>\n";
    text += fmt::format(
        "<FieldData>\n<DataArray type=\"Float64\" Name=\"TimeValue\" NumberOfTuples=\"1\" "
        "format=\"ascii\">{}</DataArray>\n</FieldData>\n",
        time);
    text += fmt::format(
        "<Piece NumberOfPoints=\"{}\" NumberOfVerts=\"1\" NumberOfLines=\"0\" NumberOfStrips=\"0\" "
        "NumberOfPolys=\"0\">\n",
        n);
    text += "<Points>\n" + points + "</Points>\n<PointData>\n" + columns + "</PointData>\n" + cell;
    text += "</Piece>\n</PolyData>\n<AppendedData encoding=\"raw\">\n_";
    return text + appended.bytes() + "\n</AppendedData>\n</VTKFile>\n";
}

VtkSeries::VtkSeries(std::filesystem::path folder, std::string name)
    : folder_(std::move(folder)), name_(std::move(name)) {}

std::string VtkSeries::file_of(std::size_t k) const {
    return fmt::format("{}_{:04}.vtp", name_, k);
}

void VtkSeries::add(const Snapshot& snapshot, double time) {
    std::error_code error;
    std::filesystem::create_directories(folder_, error);
    if (error) throw store::BrokenWorld(fmt::format("cannot make {}: {}", folder_.string(), error.message()));
    if (times_.empty())  // what a longer series of this name left behind would lie between these moments
        for (std::size_t k = 1; std::filesystem::remove(folder_ / file_of(k), error);) ++k;
    write(folder_ / file_of(times_.size()), vtp(snapshot, time));
    times_.push_back(time);
    std::string text = "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"1.0\">\n<Collection>\n";
    for (std::size_t k = 0; k < times_.size(); ++k)
        text += fmt::format("<DataSet timestep=\"{}\" part=\"0\" file=\"{}\"/>\n", times_[k], file_of(k));
    write(collection(), text + "</Collection>\n</VTKFile>\n");
}

}  // namespace grainsweep::report
