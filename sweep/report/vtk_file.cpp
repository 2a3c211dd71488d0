#include "sweep/report/vtk_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <stdexcept>
#include <vector>

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

void require_length(std::string_view what, const std::string& name, std::size_t found, std::size_t expected) {
    if (found != expected)
        throw std::invalid_argument(
            fmt::format("column '{}' of a picture has {} values for {} {}", name, found, expected, what));
}

std::string array(std::string_view type, std::string_view name, int components, std::size_t offset) {
    return fmt::format(R"(<DataArray type="{}" Name="{}" NumberOfComponents="{}" format="appended" offset="{}"/>)"
                       "\n",
                       type, name, components, offset);
}

std::string column(Appended& appended, std::string_view name, std::span<const double> values) {
    std::vector<float> single;
    single.reserve(values.size());
    for (const double x : values) single.push_back(static_cast<float>(x));
    return array("Float32", name, 1, appended.add(std::span<const float>(single)));
}

std::string column(Appended& appended, std::string_view name, std::span<const std::array<double, 3>> values) {
    std::vector<float> single;
    single.reserve(3 * values.size());
    for (const auto& v : values)
        for (const double x : v) single.push_back(static_cast<float>(x));
    return array("Float32", name, 3, appended.add(std::span<const float>(single)));
}

std::string indices(Appended& appended, std::string_view name, const std::vector<std::int64_t>& values) {
    return array("Int64", name, 1, appended.add(std::span<const std::int64_t>(values)));
}

/// All columns of particles, or all quantities of cells.
template <class Owner>
std::string appended_columns(Appended& appended, const Owner& owner, std::string_view what, std::size_t n) {
    std::string text;
    for (const auto& [name, values] : owner.scalars) {
        require_length(what, name, values.size(), n);
        text += column(appended, name, values);
    }
    for (const auto& [name, values] : owner.vectors) {
        require_length(what, name, values.size(), n);
        text += column(appended, name, values);
    }
    return text;
}

/// One cell whose corners are all particles.
std::string all_in_one_cell(Appended& appended, std::size_t particles) {
    std::vector<std::int64_t> corners(particles);
    for (std::size_t i = 0; i < particles; ++i) corners[i] = static_cast<std::int64_t>(i);
    const std::vector<std::int64_t> end{static_cast<std::int64_t>(particles)};
    return "<Verts>\n" + indices(appended, "connectivity", corners) + indices(appended, "offsets", end) + "</Verts>\n";
}

template <std::size_t Corners>
std::string cells(Appended& appended, std::string_view tag,
                  const std::vector<std::array<std::int32_t, Corners>>& list) {
    std::vector<std::int64_t> corners, ends;
    for (const auto& cell : list) {
        corners.insert(corners.end(), cell.begin(), cell.end());
        ends.push_back(static_cast<std::int64_t>(corners.size()));
    }
    return fmt::format("<{0}>\n{1}{2}</{0}>\n", tag, indices(appended, "connectivity", corners),
                       indices(appended, "offsets", ends));
}

/// A file of the kind whose contents are `inside`, a Piece element with all about it.
std::string file(std::string_view kind, std::string_view attributes, double time, std::string_view inside,
                 const Appended& appended) {
    std::string text = fmt::format(
        "<?xml version=\"1.0\"?>\n"
        "<VTKFile type=\"{0}\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\">\n"
        "<{0}{1}>\n"
        "<FieldData>\n<DataArray type=\"Float64\" Name=\"TimeValue\" NumberOfTuples=\"1\" "
        "format=\"ascii\">{2}</DataArray>\n</FieldData>\n{3}</{0}>\n<AppendedData encoding=\"raw\">\n_",
        kind, attributes, time, inside);
    return text + appended.bytes() + "\n</AppendedData>\n</VTKFile>\n";
}

std::string poly_piece(std::size_t points, std::size_t verts, std::size_t lines, std::size_t polys) {
    return fmt::format(
        "<Piece NumberOfPoints=\"{}\" NumberOfVerts=\"{}\" NumberOfLines=\"{}\" NumberOfStrips=\"0\" "
        "NumberOfPolys=\"{}\">\n",
        points, verts, lines, polys);
}

void check(const FlowField& field) {
    for (const auto& axis : field.faces) {
        const bool grows = std::ranges::adjacent_find(axis, std::greater_equal<>()) == axis.end();
        if (axis.size() < 2 || !grows)
            throw std::invalid_argument(
                fmt::format("an axis of the field '{}' of a picture does not grow", field.name));
    }
}

double width(const std::vector<double>& axis) {
    return (axis.back() - axis.front()) / static_cast<double>(axis.size() - 1);
}

bool equal_cells(const std::vector<double>& axis) {
    for (std::size_t i = 0; i < axis.size(); ++i) {
        const double expected = axis.front() + static_cast<double>(i) * width(axis);
        if (std::abs(axis[i] - expected) > 1e-9 * (axis.back() - axis.front())) return false;
    }
    return true;
}

}  // namespace

bool shows_particles(const Snapshot& snapshot) {
    return !snapshot.positions.empty() || !snapshot.scalars.empty() || !snapshot.vectors.empty();
}

std::string vtp(const Snapshot& snapshot, double time) {
    const std::size_t n = snapshot.positions.size();
    if (n > static_cast<std::size_t>(std::numeric_limits<std::int32_t>::max()))
        throw std::invalid_argument("a picture holds too many particles");
    Appended appended;
    std::string inside = poly_piece(n, 1, 0, 0);
    inside += "<Points>\n" + column(appended, "Points", snapshot.positions) + "</Points>\n";
    inside += "<PointData>\n" + appended_columns(appended, snapshot, "particles", n) + "</PointData>\n";
    inside += all_in_one_cell(appended, n) + "</Piece>\n";
    return file("PolyData", "", time, inside, appended);
}

std::string vtp(const WallSurface& wall, double time) {
    Appended appended;
    std::string inside = poly_piece(wall.corners.size(), 0, wall.edges.size(), wall.triangles.size());
    inside += "<Points>\n" + column(appended, "Points", wall.corners) + "</Points>\n";
    inside += cells(appended, "Lines", wall.edges) + cells(appended, "Polys", wall.triangles) + "</Piece>\n";
    return file("PolyData", "", time, inside, appended);
}

std::string vtp(const ContactLines& contacts, double time) {
    const std::size_t n = contacts.ends.size();
    Appended appended;
    std::vector<std::array<double, 3>> points;
    std::vector<std::array<std::int32_t, 2>> lines;
    for (const auto& [from, to] : contacts.ends) {
        const auto first = static_cast<std::int32_t>(points.size());
        lines.push_back({first, first + 1});
        points.push_back(from), points.push_back(to);
    }
    std::string inside = poly_piece(points.size(), 0, n, 0);
    inside += "<Points>\n" + column(appended, "Points", points) + "</Points>\n";
    inside += "<CellData>\n" + appended_columns(appended, contacts, "contacts", n) + "</CellData>\n";
    inside += cells(appended, "Lines", lines) + "</Piece>\n";
    return file("PolyData", "", time, inside, appended);
}

std::string_view extension_of(const FlowField& field) {
    check(field);
    return std::ranges::all_of(field.faces, equal_cells) ? ".vti" : ".vtr";
}

std::string vtk_grid(const FlowField& field, double time) {
    const bool image = extension_of(field) == ".vti";
    const auto& [x, y, z] = field.faces;
    const std::string extent = fmt::format("0 {} 0 {} 0 {}", x.size() - 1, y.size() - 1, z.size() - 1);
    std::string attributes = fmt::format(" WholeExtent=\"{}\"", extent);
    Appended appended;
    std::string inside = fmt::format("<Piece Extent=\"{}\">\n<CellData>\n", extent);
    inside += appended_columns(appended, field, "cells", field.cells()) + "</CellData>\n";
    if (image) {
        attributes += fmt::format(" Origin=\"{} {} {}\" Spacing=\"{} {} {}\"", x.front(), y.front(), z.front(),
                                  width(x), width(y), width(z));
    } else {
        inside += "<Coordinates>\n";
        for (const auto& [name, axis] : {std::pair{"x", &x}, std::pair{"y", &y}, std::pair{"z", &z}})
            inside += array("Float64", name, 1, appended.add(std::span<const double>(*axis)));
        inside += "</Coordinates>\n";
    }
    return file(image ? "ImageData" : "RectilinearGrid", attributes, time, inside + "</Piece>\n", appended);
}

}  // namespace grainsweep::report
