// The functions of a C library that compilers call by themselves; the module has no other part of one. Words are eight
// bytes; WebAssembly reads and writes them at any address. Built without link-time optimisation, which would take these
// for unused, and without builtins, which would make each call itself.
#include <cstddef>
#include <cstdint>

namespace {

struct __attribute__((packed, may_alias)) Word {
    uint64_t value;
};

constexpr size_t kLong = 128;  // from here on, the instructions that fill and copy memory are quicker

}  // namespace

extern "C" {

void* memcpy(void* __restrict to, const void* __restrict from, size_t size) {
    if (size >= kLong) return __builtin_memcpy(to, from, size);
    auto* t = static_cast<uint8_t*>(to);
    const auto* f = static_cast<const uint8_t*>(from);
    for (; size >= 8; size -= 8, t += 8, f += 8)
        reinterpret_cast<Word*>(t)->value = reinterpret_cast<const Word*>(f)->value;
    for (; size > 0; --size) *t++ = *f++;
    return to;
}

void* memmove(void* to, const void* from, size_t size) {
    auto* t = static_cast<uint8_t*>(to);
    const auto* f = static_cast<const uint8_t*>(from);
    if (t <= f || t >= f + size) {
        // Forwards, and a word is read before the one that overlaps it is written.
        for (; size >= 8; size -= 8, t += 8, f += 8)
            reinterpret_cast<Word*>(t)->value = reinterpret_cast<const Word*>(f)->value;
        for (; size > 0; --size) *t++ = *f++;
    } else {
        for (; size > 0; --size) t[size - 1] = f[size - 1];
    }
    return to;
}

void* memset(void* to, int value, size_t size) {
    if (size >= kLong) return __builtin_memset(to, value, size);
    auto* t = static_cast<uint8_t*>(to);
    const uint64_t word = 0x0101010101010101u * static_cast<uint8_t>(value);
    for (; size >= 8; size -= 8, t += 8) reinterpret_cast<Word*>(t)->value = word;
    for (; size > 0; --size) *t++ = static_cast<uint8_t>(value);
    return to;
}
}
