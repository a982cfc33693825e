#include <cstdio>
#include <exception>
#include <new>

#include "tools/commands.h"
#include "tools/removal.h"

int main(int argc, char** argv) {
    gim::prepare_process();
    // Nothing throws in normal work. If memory runs out, the program must still end with a message and status 1.
    try {
        return gim::run_gim(argc, argv);
    } catch (const std::bad_alloc&) {
        std::fputs("gim: out of memory; use a smaller --size or a smaller mesh\n", stderr);
    } catch (const std::exception& failure) {
        std::fprintf(stderr, "gim: unexpected failure: %s\n", failure.what());
    }
    return 1;
}
