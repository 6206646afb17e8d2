# Build the report's page with Node: cmake -DWEB=web -DPAGE=out.html -DNODE=node -DNPM=npm -P build_page.cmake
# A failure (no network for `npm ci`, say) leaves an empty page and a warning: the program is then built without it.
file(LOCK ${WEB}/.npm.lock GUARD PROCESS)  # build trees share node_modules

set(failed "")
if(NOT EXISTS ${WEB}/node_modules/.package-lock.json OR
   ${WEB}/package-lock.json IS_NEWER_THAN ${WEB}/node_modules/.package-lock.json)
  execute_process(COMMAND ${NPM} ci --ignore-scripts --no-audit --no-fund --loglevel=error WORKING_DIRECTORY ${WEB}
                  RESULT_VARIABLE status OUTPUT_QUIET ERROR_VARIABLE errors)
  if(status EQUAL 0)
    file(TOUCH ${WEB}/node_modules/.package-lock.json)
  else()
    set(failed "npm ci: ${errors}")
  endif()
endif()
if(NOT failed)
  get_filename_component(directory ${PAGE} DIRECTORY)
  file(REMOVE ${directory}/index.html)
  execute_process(COMMAND ${NODE} node_modules/vite/bin/vite.js build --logLevel=warn --outDir ${directory}
                  WORKING_DIRECTORY ${WEB} RESULT_VARIABLE status OUTPUT_VARIABLE errors ERROR_VARIABLE errors)
  if(NOT status EQUAL 0 OR NOT EXISTS ${directory}/index.html)
    set(failed "vite build: ${errors}")
  endif()
endif()
if(failed)
  file(WRITE ${PAGE} "")
  message(WARNING "the page of `tendril report` could not be built, the program goes without it.\n${failed}"
                  "Take a prebuilt one with -DTENDRIL_REPORT_HTML=report.html, or remove ${PAGE} and build again.")
else()
  file(RENAME ${directory}/index.html ${PAGE})
endif()
