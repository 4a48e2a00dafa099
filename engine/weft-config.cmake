# find_package(weft): defines the target weft::weft.
include(CMakeFindDependencyMacro)
find_dependency(TBB)
include(${CMAKE_CURRENT_LIST_DIR}/weft-targets.cmake)
