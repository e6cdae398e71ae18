# Read when the packages are made, because the version may be given as late as that; all of one version belong together.
set(same_version "chorus-common (= ${CPACK_PACKAGE_VERSION})")
set(CPACK_DEBIAN_SENSOR_PACKAGE_DEPENDS "${same_version}")
set(CPACK_DEBIAN_FUSION_PACKAGE_DEPENDS "${same_version}")
set(CPACK_DEBIAN_TOOLS_PACKAGE_DEPENDS "${same_version}")
set(CPACK_DEBIAN_CAMERA_PACKAGE_DEPENDS "chorus-sensor (= ${CPACK_PACKAGE_VERSION}), nodejs")
