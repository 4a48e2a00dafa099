# find_package(weft): defines the target weft::weft.
include(CMakeFindDependencyMacro)
find_dependency(TBB 2021.8)
include(${CMAKE_CURRENT_LIST_DIR}/weft-targets.cmake)
# A project of C alone does not link the runtime of C++, which a static library needs.
get_property(weft_languages GLOBAL PROPERTY ENABLED_LANGUAGES)
get_target_property(weft_kind weft::weft TYPE)
if(weft_kind STREQUAL "STATIC_LIBRARY" AND NOT "CXX" IN_LIST weft_languages)
  set_property(TARGET weft::weft APPEND PROPERTY INTERFACE_LINK_LIBRARIES stdc++ m)
endif()
