// Coordinates far from 0, huge and tiny ones, as users of the gim program meet them.
#include <gtest/gtest.h>

#include <ImfHeader.h>
#include <ImfInputFile.h>
#include <ImfVecAttribute.h>

#include <nlohmann/json.hpp>

#include "tests/tools/program.h"

namespace gim {
namespace {

using nlohmann::json;
using test::gim;
using test::Outcome;
using test::TemporaryFolder;

void save_placed(const std::string& path, double scale, const std::array<double, 3>& origin) {
    TriangleMesh mesh = corpus::corpus().named("torus-576").mesh();
    for (auto& p : mesh.positions) {
        for (size_t k = 0; k < 3; ++k) p[k] = origin[k] + scale * p[k];
    }
    test::save(path, test::obj_text(mesh));
}

double psnr_of(const std::string& reference, const std::string& test) {
    const Outcome compare = gim({"compare", reference, test, "--json", "--samples", "20000"});
    EXPECT_EQ(compare.status, 0) << compare.err;
    return json::parse(compare.out)["comparison"]["psnr"];
}

TEST(CoordinatesCli, FormatsWithDoublesKeepASurfaceAtUtmCoordinates) {
    const TemporaryFolder folder;
    const std::string mesh = folder.file("utm.obj"), file = folder.file("utm.gim");
    save_placed(mesh, 1, {500000.3, 4000000.7, 251.1});
    const Outcome encode = gim({"encode", mesh, file, "--size", "65", "--threads", "1", "--psnr", "61"});
    ASSERT_EQ(encode.status, 0) << encode.err;
    EXPECT_GE(psnr_of(mesh, file), 60);

    const json info = json::parse(gim({"info", file, "--json"}).out);
    EXPECT_EQ(info["relative"], true);
    EXPECT_NEAR(info["origin"][1].get<double>(), 4000000.7, 10);
    EXPECT_NE(gim({"info", file}).out.find("origin 49999"), std::string::npos);

    for (const std::string extension : {"ply", "obj", "off", "glb"}) {
        const std::string path = folder.file("out." + extension);
        const Outcome decode = gim({"decode", file, path});
        ASSERT_EQ(decode.status, 0) << decode.err;
        EXPECT_EQ(decode.err, "") << extension;
        EXPECT_GE(psnr_of(mesh, path), 60) << extension;
        EXPECT_GE(psnr_of(file, path), 140) << extension;
    }
    const Outcome stl = gim({"decode", file, folder.file("out.stl")});
    EXPECT_EQ(stl.status, 0);
    EXPECT_NE(stl.err.find("warning: STL holds 32-bit numbers: positions are rounded by up to 0.1"), std::string::npos)
        << stl.err;
    const Outcome exr = gim({"decode", file, folder.file("out.exr")});
    EXPECT_EQ(exr.status, 0);
    EXPECT_NE(exr.err.find("relative to the attribute gimOrigin"), std::string::npos) << exr.err;
    const Imf::InputFile image(folder.file("out.exr").c_str());
    const auto* origin = image.header().findTypedAttribute<Imf::V3dAttribute>("gimOrigin");
    ASSERT_NE(origin, nullptr);
    EXPECT_EQ(origin->value().x, info["origin"][0].get<double>());
    EXPECT_EQ(gim({"render", mesh, folder.file("out.png"), "--gim", file}).status, 0);
}

TEST(CoordinatesCli, SeveralComponentsAndChartsFarAwayAreMeasuredTogether) {
    const TemporaryFolder folder;
    const std::string mesh = folder.file("two.obj"), file = folder.file("two.gim");
    TriangleMesh both = corpus::corpus().named("torus-576").mesh();
    const TriangleMesh one = both;
    const auto base = static_cast<uint32_t>(both.positions.size());
    for (const auto& p : one.positions) both.positions.push_back({p[0] + 5, p[1], p[2]});
    for (const auto& t : one.triangles) both.triangles.push_back({t[0] + base, t[1] + base, t[2] + base});
    for (auto& p : both.positions) p = {p[0] - 700000.1, p[1] + 5000000.2, p[2]};
    test::save(mesh, test::obj_text(both));
    for (const std::string layout : {"gim", "mcgim"}) {
        const Outcome encode = gim({"encode", mesh, file, "--layout", layout, "--size", "65", "--samples", "8000",
                                    "--threads", "1", "--fit", "none"});
        ASSERT_EQ(encode.status, 0) << encode.err;
        EXPECT_GT(psnr_of(mesh, file), 50) << layout;
        for (const std::string extension : {"ply", "glb"}) {
            const std::string path = folder.file("out." + extension);
            ASSERT_EQ(gim({"decode", file, path}).status, 0);
            EXPECT_GT(psnr_of(file, path), 140) << layout << extension;
        }
    }
}

TEST(CoordinatesCli, WhatTheFormatCannotHoldIsRefusedAtOnce) {
    const TemporaryFolder folder;
    for (const auto& [scale, why] : {std::pair{1e60, "too large"}, {1e30, "too large"}, {1e-30, "too small"}}) {
        save_placed(folder.file("m.obj"), scale, {});
        const Outcome encode = gim({"encode", folder.file("m.obj"), folder.file("m.gim")});
        EXPECT_EQ(encode.status, 1);
        EXPECT_NE(encode.err.find("vertex "), std::string::npos) << encode.err;
        EXPECT_NE(encode.err.find(std::string("coordinates ") + why), std::string::npos) << encode.err;
        EXPECT_FALSE(std::filesystem::exists(folder.file("m.gim")));
        EXPECT_GT(psnr_of(folder.file("m.obj"), folder.file("m.obj")), 250);  // compare measures them all the same
        EXPECT_EQ(gim({"render", folder.file("m.obj"), folder.file("m.png")}).status, 0);
    }
}

}  // namespace
}  // namespace gim
