// Brings a refined mesh to what a rule wants: splits where vertices are needed, welds where they are not.
// After ROAM (Duchaineau et al. 1997): with a budget of triangles, the most needed split goes on until it would cost a
// vertex that is needed more. Errors that include all later ones make needs fall from split to split, so that hardly any
// split forces another one: Lindstrom, Pascucci. Terrain simplification simplified. 2002.
#pragma once

#include <cstdint>

#include "decoder/pyramid/arena.h"
#include "decoder/refine/refined_mesh.h"
#include "gim/refine.h"

namespace gim {

// How much vertices are needed (gim_rule). 0 is not at all.
class Needs {
  public:
    Needs(const gim_rule& rule, const QuadDomain& domain);

    float of(uint32_t vertex) const;
    float keep() const { return keep_; }
    // Whether needs depend on the eye and on the vertex alone.
    bool follow_the_eye() const;
    // How far the eye may move, at least, until a vertex that is there may go, or one that is not must come. Below 0: now.
    // follow_the_eye() holds.
    float room_to_stay(uint32_t vertex) const;
    float room_to_stay_away(uint32_t vertex) const;

  private:
    bool is_outside(const SampleValue& value) const;

    float distance_to_eye(const SampleValue& value) const;

    const gim_rule& rule_;
    const QuadDomain& domain_;
    float keep_, pixels_, per_unit_;
    bool has_box_;
};

// Numbers of triangles or vertices, the one of the highest priority first. Its memory is the caller's.
class NeedQueue {
  public:
    struct Entry {
        float priority;
        uint32_t number;
    };
    NeedQueue() = default;
    NeedQueue(Entry* entries, uint32_t room) : entries_(entries), room_(room) {}

    void clear() { count_ = 0; }
    bool is_full() const { return count_ == room_; }
    bool is_empty() const { return count_ == 0; }
    const Entry& first() const { return entries_[0]; }
    void push(Entry entry);
    void pop();

  private:
    Entry* entries_ = nullptr;
    uint32_t room_ = 0, count_ = 0;
};

// Which triangles need not be looked at again, because the eye has not come far enough to change what holds for them. Far
// ones wait long. Distances are counted in steps of a length that fits the mesh.
class Patience {
  public:
    // To be called before a rule is applied to the mesh. Forgets all if more than the eye has changed.
    void begin(const Needs& needs, const gim_rule& rule, RefinedMesh* mesh);

    bool may_wait(uint32_t triangle) const { return is_on_ && mesh_->patience(triangle) > travelled_; }
    // The triangle stays as it is until the eye has moved so far.
    void wait(uint32_t triangle, float room);
    bool is_on() const { return is_on_; }

  private:
    void forget();
    void rebase();

    RefinedMesh* mesh_ = nullptr;
    gim_rule last_{};
    float step_ = 0, travel_ = 0;  // length of a step; steps that the eye has come
    uint32_t travelled_ = 0;       // the same, rounded up
    bool is_on_ = false;
};

class Refiner {
  public:
    // Takes room for queues from the arena.
    Refiner(RefinedMesh* mesh, Arena* arena);

    // Returns whether nothing is left to do.
    bool run(const gim_rule& rule, uint32_t most_operations);

  private:
    bool sweep(const Needs& needs, uint32_t most_triangles, uint32_t* operations);
    bool run_within(const Needs& needs, uint32_t most_triangles, uint32_t* operations);
    void fill_queues(const Needs& needs);
    void skip_stale(const Needs& needs);
    void queue_split(const Needs& needs, uint32_t triangle);
    void queue_weld(const Needs& needs, uint32_t vertex);
    void split_and_queue(const Needs& needs, uint32_t triangle);
    void weld_and_queue(const Needs& needs, uint32_t vertex);

    void let_wait(const Needs& needs, uint32_t triangle, uint32_t middle);

    RefinedMesh* mesh_;
    NeedQueue splits_, welds_;
    Patience patience_;
};

}  // namespace gim
