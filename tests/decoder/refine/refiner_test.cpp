// Rules: what is needed is there, what is not is not, and a budget is spent on what is needed most.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/decoder/refine/refinable.h"
#include "tests/random_numbers.h"

namespace gim {
namespace {

using namespace gim::test;

float error_of(const Refinable& r, uint32_t vertex) {
    float error, radius;
    gim_vertex_worth(r.domain, vertex, &error, &radius);
    return error;
}

gim_rule object_rule(float error) {
    gim_rule rule{};
    rule.object_error = error;
    return rule;
}

// The half of all samples that matter most.
float middle_error(const Refinable& r) {
    std::vector<float> errors;
    for (uint32_t v = 0; v < r.shape.vertex_count; ++v) errors.push_back(error_of(r, v));
    std::sort(errors.begin(), errors.end());
    return std::max(errors[errors.size() / 2], 1e-6f);
}

std::set<uint32_t> vertices_of(const Refinable& r) {
    std::set<uint32_t> all;
    for (const Face& face : r.faces()) all.insert(face.begin(), face.end());
    return all;
}

TEST(Refiner, VerticesWhoseErrorIsTooLargeAreThereAndNoOthers) {
    for (const char* name : kRefinables) {
        SCOPED_TRACE(name);
        Refinable r(name);
        const std::set<uint32_t> base = vertices_of(r);
        const float error = middle_error(r);
        const gim_rule rule = object_rule(error);
        uint32_t done = 0;
        ASSERT_EQ(gim_refine(r.mesh, &rule, 0, &done), GIM_OK);
        EXPECT_EQ(done, 1u);
        expect_sound(r);
        const std::set<uint32_t> there = vertices_of(r);
        for (uint32_t v = 0; v < r.shape.vertex_count; ++v)
            ASSERT_EQ(there.count(v) == 1, base.count(v) == 1 || error_of(r, v) > error) << v;
    }
}

// What need not be looked at again changes nothing: the mesh is that of a rule which looks at everything, frame by frame.
TEST(Refiner, PatienceChangesNothing) {
    for (const char* name : kRefinables) {
        SCOPED_TRACE(name);
        Refinable patient(name), eager(name);
        Random random(17);
        gim_rule rule{};
        rule.pixels_per_unit = 200;
        const float size = std::abs(patient.positions[0]) + 1;
        float* eye = rule.eye;
        for (size_t k = 0; k < 3; ++k) eye[k] = patient.positions[k] + 20 * size;
        float speed[3] = {};
        for (int frame = 0; frame < 400; ++frame) {
            // Small steps, sometimes a jump, sometimes another rule.
            for (size_t k = 0; k < 3; ++k) {
                speed[k] += static_cast<float>(between(random, -0.01, 0.01)) * size;
                eye[k] += speed[k] + (frame % 97 == 96 ? 5 * size : 0);
                if (std::abs(eye[k] - patient.positions[k]) > 25 * size) speed[k] = -0.5f * speed[k];
            }
            rule.pixel_error = frame % 150 < 100 ? 1.0f : 2.0f;
            gim_rule looks_at_all = rule;
            looks_at_all.need = [](void*, uint32_t, const float*, float, float) { return 0.0f; };
            ASSERT_EQ(gim_refine(patient.mesh, &rule, 0, nullptr), GIM_OK);
            ASSERT_EQ(gim_refine(eager.mesh, &looks_at_all, 0, nullptr), GIM_OK);
            ASSERT_EQ(patient.faces(), eager.faces()) << frame;
        }
    }
}

TEST(Refiner, ACoarserRuleWeldsAndAFinerOneSplits) {
    Refinable r("tiles-cube-lossy");
    const float error = middle_error(r);
    uint32_t last = 0;
    for (const float factor : {4.0f, 1.0f, 0.1f}) {
        const gim_rule rule = object_rule(error * factor);
        ASSERT_EQ(gim_refine(r.mesh, &rule, 0, nullptr), GIM_OK);
        EXPECT_GT(r.count(), last);
        last = r.count();
    }
    const gim_rule none = object_rule(1e9f);
    ASSERT_EQ(gim_refine(r.mesh, &none, 0, nullptr), GIM_OK);
    EXPECT_EQ(r.count(), 2 * r.shape.tile_count);
}

TEST(Refiner, WithinHysteresisNothingChanges) {
    Refinable r("tiles-torus-lossy");
    const float error = middle_error(r);
    gim_rule rule = object_rule(error);
    ASSERT_EQ(gim_refine(r.mesh, &rule, 0, nullptr), GIM_OK);
    gim_changes c;
    gim_take_changes(r.mesh, &c);
    rule.object_error = error * 1.2f;
    ASSERT_EQ(gim_refine(r.mesh, &rule, 0, nullptr), GIM_OK);
    gim_take_changes(r.mesh, &c);
    EXPECT_EQ(c.changed_count, 0u);
    rule.object_error = error * 1.5f;
    ASSERT_EQ(gim_refine(r.mesh, &rule, 0, nullptr), GIM_OK);
    gim_take_changes(r.mesh, &c);
    EXPECT_GT(c.removed_count, 0u);
}

TEST(Refiner, ErrorsOnScreenAreBelowTheLimitWhereverTheEyeIs) {
    Random random(3);
    for (const char* name : kRefinables) {
        SCOPED_TRACE(name);
        Refinable r(name);
        for (int view = 0; view < 20; ++view) {
            gim_rule rule{};
            rule.pixel_error = 1;
            rule.pixels_per_unit = 500;
            for (float& x : rule.eye) x = static_cast<float>(between(random, -6, 6));
            ASSERT_EQ(gim_refine(r.mesh, &rule, 0, nullptr), GIM_OK);
            const std::set<uint32_t> there = vertices_of(r);
            for (uint32_t v = 0; v < r.shape.vertex_count; ++v) {
                if (there.count(v)) continue;
                float square = 0;
                for (size_t k = 0; k < 3; ++k) {
                    const float d = r.positions[3 * size_t{v} + k] - rule.eye[k];
                    square += d * d;
                }
                ASSERT_LE(error_of(r, v) * rule.pixels_per_unit, 1.001f * rule.pixel_error * std::sqrt(square));
            }
        }
        expect_sound(r);
    }
}

TEST(Refiner, ABudgetIsSpentOnWhatIsNeededMost) {
    for (const char* name : kRefinables) {
        SCOPED_TRACE(name);
        Refinable r(name);
        const uint32_t least = 2 * r.shape.tile_count, most = static_cast<uint32_t>(r.shape.most_triangles);
        for (const uint32_t budget :
             {least + (most - least) / 3, least + (most - least) / 10, least + (most - least) / 2}) {
            gim_rule rule = object_rule(1e-7f);
            rule.most_triangles = budget;
            uint32_t done = 0;
            ASSERT_EQ(gim_refine(r.mesh, &rule, 0, &done), GIM_OK);
            EXPECT_EQ(done, 1u);
            EXPECT_LE(r.count(), budget);
            EXPECT_GT(r.count() + 42, budget);  // a split forces 20 others at most
            expect_sound(r);
            // What is missing is not needed clearly more than what could go.
            float least_there = HUGE_VALF, most_missing = 0;
            const std::set<uint32_t> there = vertices_of(r);
            for (const uint32_t v : there) {
                if (gim_weld(r.mesh, v) != GIM_OK) continue;
                least_there = std::min(least_there, error_of(r, v));
            }
            for (uint32_t v = 0; v < r.shape.vertex_count; ++v) {
                if (!there.count(v)) most_missing = std::max(most_missing, error_of(r, v));
            }
            EXPECT_GE(least_there, 0.74f * most_missing);  // gim_rule.keep
        }
    }
}

TEST(Refiner, OnlyTheRegionIsRefined) {
    Refinable r("tiles-torus-lossy");
    gim_rule rule = object_rule(1e-7f);
    const float* centre = r.positions.data();
    for (size_t k = 0; k < 3; ++k) rule.sphere[k] = centre[k];
    rule.sphere[3] = 0.05f;
    ASSERT_EQ(gim_refine(r.mesh, &rule, 0, nullptr), GIM_OK);
    const uint32_t in_sphere = r.count();
    EXPECT_GT(in_sphere, 2 * r.shape.tile_count);
    EXPECT_LT(in_sphere, r.shape.most_triangles / 2);
    expect_sound(r);

    rule.sphere[3] = 0;
    for (size_t k = 0; k < 3; ++k) rule.box[k] = centre[k] - 0.05f, rule.box[k + 3] = centre[k] + 0.05f;
    ASSERT_EQ(gim_refine(r.mesh, &rule, 0, nullptr), GIM_OK);
    EXPECT_GE(r.count(), in_sphere);
    EXPECT_LT(r.count(), r.shape.most_triangles / 2);

    const float plane[4] = {1, 0, 0, -1e6f};  // all is outside
    rule.planes = plane;
    rule.plane_count = 1;
    ASSERT_EQ(gim_refine(r.mesh, &rule, 0, nullptr), GIM_OK);
    EXPECT_EQ(r.count(), 2 * r.shape.tile_count);
}

TEST(Refiner, ACallbackMayAskForAnything) {
    Refinable r("sphere-33-lossy");
    struct Wish {
        Random random{4};
        static float need(void* user, uint32_t, const float*, float, float) {
            return static_cast<float>(between(static_cast<Wish*>(user)->random, 0, 2));
        }
    } wish;
    gim_rule rule{};
    rule.need = Wish::need;
    rule.user = &wish;
    rule.most_triangles = r.count() + 200;
    for (int i = 0; i < 20; ++i) {
        ASSERT_EQ(gim_refine(r.mesh, &rule, 0, nullptr), GIM_OK);
        EXPECT_LE(r.count(), rule.most_triangles);
        expect_sound(r);
    }
}

TEST(Refiner, OperationsAreLimited) {
    Refinable r("tiles-cube-lossy");
    const gim_rule rule = object_rule(1e-7f);
    uint32_t done = 1, calls = 0;
    ASSERT_EQ(gim_refine(r.mesh, &rule, 5, &done), GIM_OK);
    EXPECT_EQ(done, 0u);
    for (; !done && calls < 10000; ++calls) ASSERT_EQ(gim_refine(r.mesh, &rule, 5, &done), GIM_OK);
    EXPECT_GT(calls, 10u);
    EXPECT_EQ(r.count(), r.shape.most_triangles);
}

TEST(Refiner, RulesThatCannotBeAreRefused) {
    Refinable r("tiles-torus-lossy");
    const auto refused = [&](const auto& change) {
        gim_rule rule = object_rule(1);
        change(rule);
        return gim_refine(r.mesh, &rule, 0, nullptr) == GIM_BAD_ARGUMENT;
    };
    EXPECT_TRUE(refused([](gim_rule& rule) { rule.object_error = -1; }));
    EXPECT_TRUE(refused([](gim_rule& rule) { rule.pixel_error = NAN; }));
    EXPECT_TRUE(refused([](gim_rule& rule) { rule.keep = 1.5f; }));
    EXPECT_TRUE(refused([](gim_rule& rule) { rule.plane_count = 1; }));
    EXPECT_TRUE(refused([](gim_rule& rule) { rule.box[0] = 1; }));
}

}  // namespace
}  // namespace gim
