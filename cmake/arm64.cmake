# Compiles the runtime, and controllers, for 64-bit ARM Linux with Debian's cross compiler. TESSERA_SYSROOT is a folder
# that scripts/arm64_sysroot has made.
set(CMAKE_SYSTEM_NAME Linux)
set(CMAKE_SYSTEM_PROCESSOR aarch64)
set(CMAKE_C_COMPILER aarch64-linux-gnu-gcc)
set(CMAKE_CXX_COMPILER aarch64-linux-gnu-g++)
set(CMAKE_LIBRARY_ARCHITECTURE aarch64-linux-gnu)

# Also for the small projects with which CMake tests the compiler.
list(APPEND CMAKE_TRY_COMPILE_PLATFORM_VARIABLES TESSERA_SYSROOT)
set(TESSERA_SYSROOT "@TESSERA_SYSROOT@" CACHE PATH "Folder that scripts/arm64_sysroot has made")
if(TESSERA_SYSROOT MATCHES "^@|^$")
  message(FATAL_ERROR "-DTESSERA_SYSROOT=FOLDER is missing: the folder that scripts/arm64_sysroot has made")
endif()
set(tessera_root "${TESSERA_SYSROOT}/root")
list(APPEND CMAKE_FIND_ROOT_PATH "${tessera_root}")
set(CMAKE_FIND_ROOT_PATH_MODE_PROGRAM NEVER)  # they run here
set(CMAKE_FIND_ROOT_PATH_MODE_LIBRARY ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_INCLUDE ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_PACKAGE BOTH)  # Tessera itself is outside
foreach(language C CXX)
  set(CMAKE_${language}_STANDARD_INCLUDE_DIRECTORIES "${tessera_root}/usr/include/aarch64-linux-gnu"
    "${tessera_root}/usr/include")
endforeach()
foreach(kind EXE SHARED MODULE)
  set(CMAKE_${kind}_LINKER_FLAGS_INIT "-Wl,-rpath-link,${tessera_root}/usr/lib/aarch64-linux-gnu")
endforeach()
set(ENV{PKG_CONFIG_SYSROOT_DIR} "${tessera_root}")
set(ENV{PKG_CONFIG_LIBDIR} "${tessera_root}/usr/lib/aarch64-linux-gnu/pkgconfig:${tessera_root}/usr/share/pkgconfig")
