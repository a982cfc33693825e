#include "decoder/refine/refiner.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "decoder/pyramid/vector3.h"

namespace gim {
namespace {

constexpr float kUsualKeep = 0.75f;
constexpr float kMostNeed = std::numeric_limits<float>::max();
constexpr uint32_t kMoreEntries = 1024;  // room of queues beyond one entry for each triangle

float distance_to_plane(const float* plane, const float* p) {
    return plane[0] * p[0] + plane[1] * p[1] + plane[2] * p[2] + plane[3];
}

}  // namespace

// ---- needs ----------------------------------------------------------------------------------------------------------

Needs::Needs(const gim_rule& rule, const QuadDomain& domain)
    : rule_(rule),
      domain_(domain),
      keep_(rule.keep > 0 ? rule.keep : kUsualKeep),
      pixels_(rule.pixel_error > 0 ? rule.pixels_per_unit / rule.pixel_error : 0),
      per_unit_(rule.object_error > 0 ? 1 / rule.object_error : 0),
      has_box_(std::any_of(rule.box, rule.box + 6, [](float x) { return x != 0; })) {}

bool Needs::is_outside(const SampleValue& value) const {
    const float *p = value.position, r = value.radius;
    if (has_box_) {
        float square = 0;
        for (size_t k = 0; k < 3; ++k) {
            const float beyond = std::max({rule_.box[k] - p[k], p[k] - rule_.box[k + 3], 0.0f});
            square += beyond * beyond;
        }
        if (square > r * r) return true;
    }
    if (rule_.sphere[3] > 0) {
        const float reach = r + rule_.sphere[3];
        if (squared_distance(p, rule_.sphere) > reach * reach) return true;
    }
    for (uint32_t i = 0; i < rule_.plane_count; ++i) {
        if (distance_to_plane(rule_.planes + 4 * size_t{i}, p) < -r) return true;
    }
    return false;
}

float Needs::of(uint32_t vertex) const {
    const SampleValue& value = domain_.value(vertex);
    if (is_outside(value)) return 0;
    float need = value.error * per_unit_;
    if (pixels_ > 0 && value.error > 0) {
        const float distance = std::sqrt(squared_distance(value.position, rule_.eye)) - value.radius;
        need = std::max(need, distance > 0 ? value.error * pixels_ / distance : kMostNeed);
    }
    if (rule_.need) need = std::max(need, rule_.need(rule_.user, vertex, value.position, value.error, value.radius));
    return std::min(need, kMostNeed);
}

bool Needs::follow_the_eye() const {
    return pixels_ > 0 && !has_box_ && rule_.sphere[3] == 0 && rule_.plane_count == 0 && !rule_.need;
}

float Needs::distance_to_eye(const SampleValue& value) const {
    return std::sqrt(squared_distance(value.position, rule_.eye)) - value.radius;
}

// The need is error * pixels / distance, so it crosses a bound where the distance is error * pixels / bound.
float Needs::room_to_stay(uint32_t vertex) const {
    const SampleValue& value = domain_.value(vertex);
    if (value.error * per_unit_ >= keep_) return kMostNeed;
    return value.error * pixels_ / keep_ - distance_to_eye(value);
}
float Needs::room_to_stay_away(uint32_t vertex) const {
    const SampleValue& value = domain_.value(vertex);
    if (value.error * per_unit_ > 1) return -1;
    if (value.error == 0) return kMostNeed;
    return distance_to_eye(value) - value.error * pixels_;
}

// ---- patience -------------------------------------------------------------------------------------------------------

namespace {

constexpr float kStepsOfMesh = 1024;         // along the diagonal of the base's box
constexpr uint32_t kMostSteps = UINT16_MAX;  // that a triangle can wait
constexpr float kStepsUntilRebase = 4096;
constexpr float kCaution = 0.99f;  // for the rounding of distances

float diagonal_of_base(const RefinedMesh& mesh) {
    const QuadDomain& domain = mesh.domain();
    float low[3] = {kMostNeed, kMostNeed, kMostNeed}, high[3] = {-kMostNeed, -kMostNeed, -kMostNeed};
    for (uint32_t h = 0; h < 4 * domain.shape().tiles; ++h) {
        const float* p = domain.value(domain.glue().corner[h]).position;
        for (int k = 0; k < 3; ++k) {
            low[k] = std::min(low[k], p[k]);
            high[k] = std::max(high[k], p[k]);
        }
    }
    return std::sqrt(squared_distance(low, high));
}

bool differ_in_more_than_the_eye(const gim_rule& a, const gim_rule& b) {
    return a.pixel_error != b.pixel_error || a.pixels_per_unit != b.pixels_per_unit ||
           a.object_error != b.object_error || a.keep != b.keep;
}

}  // namespace

void Patience::begin(const Needs& needs, const gim_rule& rule, RefinedMesh* mesh) {
    if (!mesh_) step_ = diagonal_of_base(*mesh) / kStepsOfMesh;
    const bool goes_on = is_on_ && !differ_in_more_than_the_eye(rule, last_);
    const float moved = std::sqrt(squared_distance(rule.eye, last_.eye)) / step_;
    mesh_ = mesh;
    last_ = rule;
    is_on_ = needs.follow_the_eye() && step_ > 0;
    if (!is_on_) return;
    if (!goes_on || !(moved < kMostSteps)) return forget();
    travel_ += moved;
    if (travel_ > kStepsUntilRebase) rebase();
    travelled_ = static_cast<uint32_t>(std::ceil(travel_));
}

void Patience::forget() {
    for (uint32_t f = 0; f < mesh_->triangle_count(); ++f) mesh_->set_patience(f, 0);
    travel_ = 0;
    travelled_ = 0;
}

void Patience::rebase() {
    const auto passed = static_cast<uint32_t>(std::ceil(travel_));
    for (uint32_t f = 0; f < mesh_->triangle_count(); ++f) {
        const uint32_t left = mesh_->patience(f) > passed ? mesh_->patience(f) - passed : 0;
        mesh_->set_patience(f, static_cast<uint16_t>(left));
    }
    travel_ = 0;
}

void Patience::wait(uint32_t triangle, float room) {
    const float until = travel_ + kCaution * room / step_;
    // 0 also where sums of very large numbers are none.
    const float whole = until > 0 ? std::min(until, static_cast<float>(kMostSteps)) : 0.0f;
    mesh_->set_patience(triangle, static_cast<uint16_t>(whole));
}

// ---- queue ----------------------------------------------------------------------------------------------------------

void NeedQueue::push(Entry entry) {
    uint32_t at = count_++;
    for (; at > 0; at = (at - 1) / 2) {
        const Entry& above = entries_[(at - 1) / 2];
        if (above.priority >= entry.priority) break;
        entries_[at] = above;
    }
    entries_[at] = entry;
}

void NeedQueue::pop() {
    const Entry last = entries_[--count_];
    uint32_t at = 0;
    for (;;) {
        uint32_t below = 2 * at + 1;
        if (below >= count_) break;
        if (below + 1 < count_ && entries_[below + 1].priority > entries_[below].priority) ++below;
        if (entries_[below].priority <= last.priority) break;
        entries_[at] = entries_[below];
        at = below;
    }
    if (count_ > 0) entries_[at] = last;
}

// ---- refiner --------------------------------------------------------------------------------------------------------

Refiner::Refiner(RefinedMesh* mesh, Arena* arena) : mesh_(mesh) {
    const uint32_t room = mesh->most_triangles() + kMoreEntries;
    splits_ = {arena->take<NeedQueue::Entry>(room), room};
    welds_ = {arena->take<NeedQueue::Entry>(room), room};
}

bool Refiner::run(const gim_rule& rule, uint32_t most_operations) {
    const Needs needs(rule, mesh_->domain());
    patience_.begin(needs, rule, mesh_);
    const uint32_t most =
        rule.most_triangles > 0 ? std::min(rule.most_triangles, mesh_->most_triangles()) : mesh_->most_triangles();
    // A need that changes from call to call must not keep it busy for ever.
    const uint64_t enough = 4 * uint64_t{mesh_->most_triangles()} + 64;
    auto operations =
        static_cast<uint32_t>(std::min<uint64_t>(most_operations > 0 ? most_operations : enough, UINT32_MAX));
    if (mesh_->triangle_count() <= most && sweep(needs, most, &operations)) return true;
    return operations > 0 && run_within(needs, most, &operations);
}

// Welds what is not needed, then splits what is, from triangle to triangle, until nothing changes. Returns false if
// operations or triangles do not suffice.
bool Refiner::sweep(const Needs& needs, uint32_t most_triangles, uint32_t* operations) {
    const auto is_last_of_vertex = [&](uint32_t f) {
        return mesh_->half_edge_at(mesh_->vertex(3 * f + 2)) == 3 * f + 2;
    };
    for (bool changed = true; changed;) {
        changed = false;
        for (uint32_t f = 0; f < mesh_->triangle_count();) {
            if (patience_.may_wait(f)) {
                ++f;
                continue;
            }
            const uint32_t v = mesh_->vertex(3 * f + 2);
            if (mesh_->level(v) == 0 || !is_last_of_vertex(f) || needs.of(v) >= needs.keep() || !mesh_->weld(v)) {
                ++f;
                continue;
            }
            changed = true;
            if (--*operations == 0) return false;
        }
    }
    for (bool changed = true; changed;) {
        changed = false;
        for (uint32_t f = 0; f < mesh_->triangle_count();) {
            if (patience_.may_wait(f)) {
                ++f;
                continue;
            }
            const uint32_t middle = mesh_->middle_of(f);
            if (!mesh_->stands_for_split(f) || middle == kNoHalfEdge || needs.of(middle) <= 1) {
                let_wait(needs, f, middle);
                ++f;
                continue;
            }
            if (mesh_->triangles_needed(f) > most_triangles - mesh_->triangle_count()) return false;
            (void)mesh_->split(f);
            changed = true;
            if (--*operations == 0) return false;
        }
    }
    return true;
}

// Whatever part a triangle has at its vertex and its first edge, nothing happens there before the eye has come so far.
void Refiner::let_wait(const Needs& needs, uint32_t triangle, uint32_t middle) {
    if (!patience_.is_on()) return;
    const uint32_t v = mesh_->vertex(3 * triangle + 2);
    float room = middle != kNoHalfEdge ? needs.room_to_stay_away(middle) : kMostNeed;
    if (mesh_->level(v) > 0) room = std::min(room, needs.room_to_stay(v));
    patience_.wait(triangle, room);
}

void Refiner::queue_split(const Needs& needs, uint32_t triangle) {
    if (!mesh_->stands_for_split(triangle) || splits_.is_full()) return;
    const uint32_t middle = mesh_->middle_of(triangle);
    const float need = middle == kNoHalfEdge ? 0 : needs.of(middle);
    if (need > 1) splits_.push({need, triangle});
}

void Refiner::queue_weld(const Needs& needs, uint32_t vertex) {
    if (!welds_.is_full() && mesh_->may_weld(vertex)) welds_.push({-needs.of(vertex), vertex});
}

void Refiner::fill_queues(const Needs& needs) {
    splits_.clear();
    welds_.clear();
    for (uint32_t f = 0; f < mesh_->triangle_count(); ++f) {
        queue_split(needs, f);
        const uint32_t v = mesh_->vertex(3 * f + 2);
        if (mesh_->half_edge_at(v) == 3 * f + 2) queue_weld(needs, v);
    }
}

// Drops entries that no longer hold.
void Refiner::skip_stale(const Needs& needs) {
    while (!splits_.is_empty()) {
        const auto [need, f] = splits_.first();
        if (f < mesh_->triangle_count() && mesh_->stands_for_split(f)) {
            const uint32_t middle = mesh_->middle_of(f);
            if (middle != kNoHalfEdge && needs.of(middle) == need) break;
        }
        splits_.pop();
    }
    while (!welds_.is_empty()) {
        const auto [need, v] = welds_.first();
        if (mesh_->may_weld(v) && -needs.of(v) == need) break;
        welds_.pop();
    }
}

void Refiner::split_and_queue(const Needs& needs, uint32_t triangle) {
    for (uint32_t first = UINT32_MAX; first != triangle;) {
        first = mesh_->first_to_split(triangle);
        const uint32_t middle = mesh_->middle_of(first);
        (void)mesh_->split(first);
        queue_weld(needs, middle);
        const uint32_t start = mesh_->half_edge_at(middle);
        mesh_->for_each_spoke(start, [&](uint32_t spoke) { queue_split(needs, triangle_of(spoke)); });
    }
}

void Refiner::weld_and_queue(const Needs& needs, uint32_t vertex) {
    uint32_t around[4], numbers[4], count = 0;
    mesh_->for_each_spoke(mesh_->half_edge_at(vertex), [&](uint32_t spoke) {
        numbers[count] = triangle_of(spoke);
        around[count++] = mesh_->vertex(3 * triangle_of(spoke));
    });
    // On a boundary, the last vertex around is no start of a first half-edge.
    const uint32_t last = mesh_->vertex(3 * numbers[count - 1] + 1);
    (void)mesh_->weld(vertex);
    for (uint32_t i = 0; i < count; ++i) queue_weld(needs, around[i]);
    if (last != around[0]) queue_weld(needs, last);
    // Those numbers now belong to the triangles that it left, and to others that were the last ones.
    for (uint32_t i = 0; i < count; ++i) {
        if (numbers[i] < mesh_->triangle_count()) queue_split(needs, numbers[i]);
    }
}

bool Refiner::run_within(const Needs& needs, uint32_t most_triangles, uint32_t* operations) {
    fill_queues(needs);
    while (*operations > 0) {
        if (splits_.is_full() || welds_.is_full()) fill_queues(needs);
        skip_stale(needs);
        const float most_needed = splits_.is_empty() ? 0 : splits_.first().priority;
        const float least_needed = welds_.is_empty() ? kMostNeed : -welds_.first().priority;
        const uint32_t count = mesh_->triangle_count();
        const bool has_room = !splits_.is_empty() && count <= most_triangles &&
                              mesh_->triangles_needed(splits_.first().number) <= most_triangles - count;
        const bool is_unneeded = least_needed < needs.keep() || count > most_triangles ||
                                 (!has_room && least_needed < most_needed * needs.keep());
        if (!welds_.is_empty() && is_unneeded) {
            const uint32_t vertex = welds_.first().number;
            welds_.pop();
            weld_and_queue(needs, vertex);
        } else if (has_room) {
            const uint32_t triangle = splits_.first().number;
            splits_.pop();
            split_and_queue(needs, triangle);
        } else {
            return true;
        }
        --*operations;
    }
    return false;
}

}  // namespace gim
