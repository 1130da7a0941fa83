# The faces: what is installed, as <cairn/...>, and nothing else of the project is. Here their names from the project's root.
#
# Sources include "renderer/renderer.h"; who uses the library, <cairn/renderer/renderer.h>. Each build copies the faces to
# ${PROJECT_BINARY_DIR}/include/cairn with their quoted includes rewritten, and fails when one of them includes a header
# that is not listed here, or OpenGL's loader, which is the library's own (cmake/WriteHeaders.cmake).
set(cairn_public_headers
  base/clock.h
  base/error.h
  gl/buffer.h
  gl/context.h
  gl/handle.h
  gl/shader_source.h
  optics/camera.h
  optics/image.h
  optics/light.h
  reference/exact_voxels.h
  reference/image.h
  reference/shadow_truth.h
  renderer/frame/frame_statistics.h
  renderer/march/march_options.h
  renderer/mesh/mix.h
  renderer/open_content.h
  renderer/pool/tree_shape.h
  renderer/produce/content.h
  renderer/produce/cpu_brick.h
  renderer/produce/volume.h
  renderer/renderer.h
  renderer/shadow/shadow_base.h
  renderer/shadow_renderer.h
  renderer/view/view.h
  scenes/load.h
  scenes/scene.h
  scenes/snapshot.h
  scenes/volume/volume.h
  voxelizer/bit_grid.h
  voxelizer/files/voxel_writer.h
  voxelizer/grid.h
  voxelizer/methods/voxelize_tiles.h
  voxelizer/methods/voxelizer.h
  voxelizer/surface/moving_surface.h
  voxelizer/surface/surface.h
  voxelizer/surface/triangle_index.h)

set(cairn_headers_dir "${PROJECT_BINARY_DIR}/include")
list(TRANSFORM cairn_public_headers PREPEND "${PROJECT_SOURCE_DIR}/" OUTPUT_VARIABLE cairn_header_sources)
list(TRANSFORM cairn_public_headers PREPEND "${cairn_headers_dir}/cairn/" OUTPUT_VARIABLE cairn_written_headers)
set(cairn_headers_stamp "${PROJECT_BINARY_DIR}/public_headers.stamp")
add_custom_command(
  OUTPUT ${cairn_headers_stamp}
  BYPRODUCTS ${cairn_written_headers}
  COMMAND ${CMAKE_COMMAND} "-DHEADERS=${cairn_public_headers}" -DFROM=${PROJECT_SOURCE_DIR} -DTO=${cairn_headers_dir}/cairn
          -P ${PROJECT_SOURCE_DIR}/cmake/WriteHeaders.cmake
  COMMAND ${CMAKE_COMMAND} -E touch ${cairn_headers_stamp}
  DEPENDS ${cairn_header_sources} ${PROJECT_SOURCE_DIR}/cmake/WriteHeaders.cmake
  COMMENT "Writing the public headers"
  VERBATIM)
add_custom_target(cairn_headers DEPENDS ${cairn_headers_stamp})

configure_file(${PROJECT_SOURCE_DIR}/cmake/version.h.in ${cairn_headers_dir}/cairn/version.h @ONLY)

foreach(header IN LISTS cairn_public_headers)
  cmake_path(GET header PARENT_PATH folder)
  install(FILES ${cairn_headers_dir}/cairn/${header} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/cairn/${folder})
endforeach()
install(FILES ${cairn_headers_dir}/cairn/version.h DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/cairn)
