// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
// GDAL creates a context of PROJ in each thread, keeps it private and has no setting for the files it may open. In a
// program this function is found before PROJ's own of the same name; a library must not impose that on programs that
// link it.
#include <dlfcn.h>

#include <thalweg/io/gdal/access.hpp>

extern "C" [[gnu::visibility("default")]] pj_ctx* proj_context_create() {
    using Create = pj_ctx* (*)();
    static auto const create = reinterpret_cast<Create>(dlsym(RTLD_NEXT, "proj_context_create"));
    pj_ctx* const context = create();
    if (context != nullptr) {
        thalweg::io::confine_proj(context);
    }
    return context;
}
