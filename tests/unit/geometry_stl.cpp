#include "solver/geometry/stl.hpp"
#include "tests/support/surfaces.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>

namespace grainsweep::tests::geometry_stl_test {

using namespace geometry;
using testing::HasSubstr;

void append(std::string& bytes, const void* from, std::size_t size) {
    const std::size_t at = bytes.size();
    bytes.resize(at + size);
    std::memcpy(bytes.data() + at, from, size);
}

std::string binary_stl(const Soup& soup, std::string header = {}) {
    header.resize(80, ' ');
    const auto count = static_cast<std::uint32_t>(soup.size());
    append(header, &count, sizeof count);
    for (const auto& triangle : soup) {
        const std::array<float, 3> normal = {NAN, NAN, NAN};  // not read
        append(header, normal.data(), sizeof normal);
        for (const Vec3& corner : triangle)
            for (const double x : corner) {
                const auto rounded = static_cast<float>(x);
                append(header, &rounded, sizeof rounded);
            }
        header.append("ab");
    }
    return header;
}

std::string text_stl(const Soup& soup, const std::string& name = "part") {
    std::string text = "solid " + name + "\n";
    for (const auto& triangle : soup) {
        text += "  facet normal 0 0 nan\r\n    OUTER loop\n";
        for (const Vec3& x : triangle) {
            char line[120];
            std::snprintf(line, sizeof line, "      vertex %.17g %+.17e %.17g\n", x[0], x[1], x[2]);
            text += line;
        }
        text += "    endloop\n  endfacet\n";
    }
    return text + "endsolid " + name + "\n";
}

/// The sentence with which contents are refused; empty: they are read.
std::string refusal(const std::string& contents, double scale = 1) {
    try {
        (void)read_stl(contents, scale);
    } catch (const std::invalid_argument& e) {
        return e.what();
    }
    return {};
}

bool same(const TriangleSurface& a, const TriangleSurface& b) {
    return a.corners == b.corners && a.triangles == b.triangles;
}

TEST(Stl, ReadsBinaryAndTextAlike) {
    const Soup soup = tests::box(4, 8);  // exact in single precision
    const auto binary = read_stl(binary_stl(soup));
    const auto text = read_stl(text_stl(soup));
    EXPECT_TRUE(binary.binary);
    EXPECT_FALSE(text.binary);
    EXPECT_TRUE(same(binary.surface, text.surface));
    EXPECT_EQ(binary.surface.triangles.size(), 12U);
    EXPECT_EQ(binary.surface.corners.size(), 8U);
    EXPECT_EQ(binary.dropped + text.dropped + binary.merged + text.merged, 0U);
    for (std::size_t t = 0; t < soup.size(); ++t)
        for (std::size_t k = 0; k < 3; ++k) {
            const auto corner = static_cast<std::size_t>(text.surface.triangles[t][k]);
            EXPECT_EQ(text.surface.corners[corner], soup[t][k]);
        }
}

TEST(Stl, AHeaderThatBeginsWithSolidMakesNoTextOfABinaryFile) {
    const Soup soup = tests::box(4, 8);
    const auto plain = read_stl(binary_stl(soup));
    const auto solid = read_stl(binary_stl(soup, "solid made by some program"));
    EXPECT_TRUE(solid.binary);
    EXPECT_TRUE(same(solid.surface, plain.surface));
}

TEST(Stl, ScalesAndReadsSeveralSolidsInOneText) {
    const Soup first = {{Vec3{0, 0, 0}, Vec3{2, 0, 0}, Vec3{0, 3, 0}}};
    const Soup second = {{Vec3{0, 0, 5}, Vec3{2, 0, 5}, Vec3{0, 3, 5}}};
    const auto read = read_stl(text_stl(first, "one part") + "\n" + text_stl(second, ""), 1e-3);
    ASSERT_EQ(read.surface.triangles.size(), 2U);
    ASSERT_EQ(read.surface.corners.size(), 6U);
    EXPECT_EQ(read.surface.corners.back(), (Vec3{1e-3 * 2, 0, 1e-3 * 5}));
}

TEST(Stl, WeldsCornersWithinSevenDigitsOfTheExtentAndNoFarther) {
    // Two triangles at a side, one of them with its corners moved by 0.9 or 1.1 of the tolerance.
    for (const double moved : {0.9, 1.1}) {
        const double extent = std::sqrt(2.0);
        const double by = moved * weld_tolerance * extent;
        const Soup soup = {{Vec3{0, 0, 0}, Vec3{1, 0, 0}, Vec3{1, 1, 0}},
                           {Vec3{0, 0, by}, Vec3{1, 1, by}, Vec3{0, 1, 0}}};
        const auto read = read_stl(text_stl(soup));
        EXPECT_EQ(read.merged, moved < 1 ? 2U : 0U);
        EXPECT_EQ(read.surface.corners.size(), moved < 1 ? 4U : 6U);
    }
}

TEST(Stl, DropsTrianglesWithoutAreaAndCountsThem) {
    Soup soup = tests::box(4, 8);
    soup.push_back({Vec3{4, 4, 0}, Vec3{4, 4, 0}, Vec3{-4, 4, 0}});      // two corners the same
    soup.push_back({Vec3{-4, -4, 0}, Vec3{0, 0, 0}, Vec3{4, 4, 0}});     // on one line
    soup.push_back({Vec3{-4, -4, 0}, Vec3{0, 1e-7, 0}, Vec3{4, 4, 0}});  // less high than corners are apart
    const auto read = read_stl(text_stl(soup));
    EXPECT_EQ(read.dropped, 3U);
    EXPECT_EQ(read.surface.triangles.size(), 12U);
    EXPECT_EQ(read.surface.corners.size(), 8U) << "corners of dropped triangles stay away";
    EXPECT_EQ(refusal(text_stl({soup[12], soup[13]})), "STL: none of its triangles has an area");
}

TEST(Stl, TheOrderOfTrianglesChangesNoCorner) {
    const Soup soup = tests::drum(37, 0.02, 0.01);
    const auto plain = read_stl(text_stl(soup));
    for (std::uint64_t seed = 1; seed < 5; ++seed)
        EXPECT_EQ(read_stl(text_stl(tests::shuffled(soup, seed))).surface.corners, plain.surface.corners);
    EXPECT_EQ(plain.surface.corners.size(), 74U);
}

TEST(Stl, RefusesWhatIsNone) {
    const std::string binary = binary_stl(tests::box(4, 8));
    const std::string text = text_stl(tests::box(4, 8));
    EXPECT_THAT(refusal(""), HasSubstr("neither text that begins with 'solid' nor"));
    EXPECT_THAT(refusal("x,y,z\n1,2,3\n"), HasSubstr("neither text that begins with 'solid' nor"));
    EXPECT_THAT(refusal("solid nothing\nendsolid nothing\n"), HasSubstr("there is no triangle"));
    EXPECT_THAT(refusal(binary_stl({})), HasSubstr("there is no triangle"));
    EXPECT_THAT(refusal(text, 0), HasSubstr("scale must be positive"));
    EXPECT_THAT(refusal(text, NAN), HasSubstr("scale must be positive"));
    // Truncated, too long, and with a count that does not fit, whatever the header says.
    for (const char* header : {"", "solid part"})
        for (const std::string& wrong :
             {binary.substr(0, 400), binary + "more", binary.substr(0, 83), binary.substr(0, 84)}) {
            std::string bytes = wrong;
            bytes.replace(0, std::strlen(header), header);
            EXPECT_THAT(refusal(bytes), HasSubstr("STL: ")) << bytes.size();
        }
    EXPECT_THAT(refusal(binary.substr(0, 400)), HasSubstr("of 12 triangles it would have 684 bytes, not 400"));
    // Text that ends early, with a wrong word, with a word for a number.
    for (std::size_t length = 1; length < text.size() - 20; length += 61)
        EXPECT_NE(refusal(text.substr(0, length)), "") << length;
    EXPECT_THAT(refusal("solid a\nfacet normal 0 0 1\nouter loop\nvertex 1 2 x"),
                HasSubstr("line 4: a number is expected, not 'x'"));
    EXPECT_THAT(refusal("solid a\nfacet normal 0 0 1\nvertex 1 2 3"), HasSubstr("line 3: 'outer' is expected"));
    EXPECT_THAT(refusal("solid a\nfacets"), HasSubstr("'facet' or 'endsolid' is expected, not 'facets'"));
    EXPECT_THAT(refusal("solid a\nfacet normal 0 0 1"), HasSubstr("and the file ends"));
}

TEST(Stl, RefusesCornersThatAreNoNumbers) {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    for (const double wrong : {std::numeric_limits<double>::quiet_NaN(), infinity, -infinity, 1e10}) {
        Soup soup = tests::box(4, 8);
        soup[7][1][2] = wrong;
        EXPECT_THAT(refusal(binary_stl(soup)), HasSubstr("triangle 8 has a corner that is no number")) << wrong;
        EXPECT_THAT(refusal(text_stl(soup)), HasSubstr("STL: ")) << wrong;
    }
}

}  // namespace grainsweep::tests::geometry_stl_test
