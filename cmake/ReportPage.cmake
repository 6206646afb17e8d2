# The page of `tendril report`: a prebuilt one (TENDRIL_REPORT_HTML), or built from web/ with Node 18 or later and npm, or
# none. Sets TENDRIL_PAGE_SOURCE, a C++ source that holds it, and TENDRIL_PAGE (empty without a page).
set(TENDRIL_REPORT_HTML "" CACHE FILEPATH "Prebuilt page of `tendril report`; empty: build it with Node where there is Node")

set(web ${PROJECT_SOURCE_DIR}/web)
set(TENDRIL_PAGE "")
set(TENDRIL_PAGE_SOURCE ${PROJECT_BINARY_DIR}/web/page_template.cpp)
if(TENDRIL_REPORT_HTML)
  if(NOT EXISTS ${TENDRIL_REPORT_HTML})
    message(FATAL_ERROR "TENDRIL_REPORT_HTML: there is no file ${TENDRIL_REPORT_HTML}")
  endif()
  set(TENDRIL_PAGE ${TENDRIL_REPORT_HTML})
else()
  find_program(TENDRIL_NODE NAMES node nodejs)
  find_program(TENDRIL_NPM npm)
  set(node_version "none")
  if(TENDRIL_NODE AND TENDRIL_NPM)
    execute_process(COMMAND ${TENDRIL_NODE} --version OUTPUT_VARIABLE node_version OUTPUT_STRIP_TRAILING_WHITESPACE)
    string(REGEX REPLACE "^v" "" node_version "${node_version}")
  endif()
  if(node_version VERSION_GREATER_EQUAL 18)
    set(TENDRIL_PAGE ${PROJECT_BINARY_DIR}/web/report.html)
    file(GLOB_RECURSE web_sources CONFIGURE_DEPENDS ${web}/src/*)
    add_custom_command(OUTPUT ${TENDRIL_PAGE}
      COMMAND ${CMAKE_COMMAND} -DWEB=${web} -DPAGE=${TENDRIL_PAGE} -DNODE=${TENDRIL_NODE} -DNPM=${TENDRIL_NPM}
              -P ${PROJECT_SOURCE_DIR}/cmake/build_page.cmake
      DEPENDS ${web_sources} ${web}/index.html ${web}/package.json ${web}/package-lock.json ${web}/vite.config.js
              ${web}/tsconfig.json ${PROJECT_SOURCE_DIR}/cmake/build_page.cmake
      COMMENT "Building the report's page" VERBATIM)
  else()
    message(STATUS "tendril report: left out, it needs Node 18 or later with npm (found: ${node_version}) "
                   "or -DTENDRIL_REPORT_HTML=report.html")
  endif()
endif()
add_custom_command(OUTPUT ${TENDRIL_PAGE_SOURCE}
  COMMAND ${CMAKE_COMMAND} -DPAGE=${TENDRIL_PAGE} -DSOURCE=${TENDRIL_PAGE_SOURCE}
          -P ${PROJECT_SOURCE_DIR}/cmake/embed_page.cmake
  DEPENDS ${TENDRIL_PAGE} ${PROJECT_SOURCE_DIR}/cmake/embed_page.cmake
  COMMENT "Embedding the report's page" VERBATIM)
