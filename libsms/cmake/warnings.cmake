# Warnings are errors in this project's own code, on every target that asks for them.
add_library(sms_warnings INTERFACE)
target_compile_options(sms_warnings INTERFACE -Wall -Wextra -Werror -Wconversion -Wfloat-equal -Wshadow
                                              $<$<COMPILE_LANGUAGE:CXX>:-Wdouble-promotion>)
if(SMS_SANITIZE)
  add_compile_options(-fsanitize=${SMS_SANITIZE} -fno-omit-frame-pointer -fno-sanitize-recover=all)
  add_link_options(-fsanitize=${SMS_SANITIZE})
endif()
