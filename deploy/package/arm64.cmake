# Cross-compiles for arm64 in a Debian root that has the libraries of both architectures (deploy/make-packages.sh makes one).
set(CMAKE_SYSTEM_NAME Linux)
set(CMAKE_SYSTEM_PROCESSOR aarch64)
set(CMAKE_CXX_COMPILER aarch64-linux-gnu-g++)
set(PKG_CONFIG_EXECUTABLE aarch64-linux-gnu-pkg-config)
set(CMAKE_CROSSCOMPILING_EMULATOR qemu-aarch64-static)  # runs what prints the manual pages
set(CPACK_DEBIAN_PACKAGE_ARCHITECTURE arm64)
