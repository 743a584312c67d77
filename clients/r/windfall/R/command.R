# The program, the words of its command line, and what it says.

windfall <- function(...) {
  places <- list(...)
  named <- names(places)
  if (is.null(named)) named <- rep("", length(places))
  folder <- tempfile("windfall-")
  dir.create(folder)
  on.exit(unlink(folder, recursive = TRUE))

  # What has no name stands where it was given; what has one is an option.
  words <- unlist(lapply(seq_along(places), function(place) {
    if (nzchar(named[place])) option_words(named[place], places[[place]], folder)
    else value_words(places[[place]], folder)
  }))
  formatted <- any(grepl("^--format(=|$)", words))
  said <- run_words(if (formatted) words else as_json(words), folder)
  # Few commands have no other form than text. They say so before they do anything.
  if (!formatted && grepl("^error: unexpected argument '--format' found", said$errors)) {
    said <- run_words(words, folder)
    formatted <- TRUE
  }
  said$errors <- without_files(said$errors, folder)
  if (said$status != 0) stop(failure(said, formatted))
  result <- if (formatted) lines_of(said$output) else from_json(said$output)
  with_messages(result, lines_of(said$errors))
}

# Where the program is.
command <- function() {
  named <- c(getOption("windfall.command"), Sys.getenv("WINDFALL"))
  named <- named[nzchar(named)]
  if (length(named) > 0) {
    found <- Sys.which(path.expand(named[[1]]))
    if (nzchar(found)) return(unname(found))
    stop("there is no program ", dQuote(named[[1]], FALSE), ", which ",
         if (is.null(getOption("windfall.command"))) "the environment variable WINDFALL"
         else "options(windfall.command = )", " names", call. = FALSE)
  }
  found <- Sys.which("windfall")
  if (!nzchar(found)) {
    stop("the program windfall is not on the search path; name it with ",
         "options(windfall.command = \"/path/to/windfall\") or the environment variable WINDFALL",
         call. = FALSE)
  }
  unname(found)
}

# Runs the program. Its output goes through files: pipes of R know no encoding.
run_words <- function(words, folder) {
  output <- file.path(folder, "output")
  errors <- file.path(folder, "errors")
  quoted <- vapply(enc2utf8(words), quote_word, "", USE.NAMES = FALSE)
  status <- system2(command(), quoted, stdout = output, stderr = errors)
  list(status = status, output = text_of(output), errors = text_of(errors))
}

# A word as the shell takes it (Unix), or as the C library of Windows cuts command lines:
# there, backslashes before a quotation mark are doubled.
quote_word <- function(word, windows = .Platform$OS.type == "windows") {
  if (!windows) return(shQuote(word))
  word <- gsub("(\\\\*)\"", "\\1\\1\\\\\"", word)
  paste0("\"", sub("(\\\\+)$", "\\1\\1", word), "\"")
}

text_of <- function(file) {
  text <- readChar(file, file.size(file), useBytes = TRUE)
  if (length(text) == 0) return("")
  Encoding(text) <- "UTF-8"
  text
}

lines_of <- function(text) {
  lines <- strsplit(text, "\r?\n")[[1]]
  if (length(lines) == 0) character() else lines
}

# Words that ask for JSON; behind "--" there are no options any more.
as_json <- function(words) {
  end <- match("--", words, nomatch = length(words) + 1)
  append(words, "--format=json", after = end - 1)
}

# An option once for each of its values.
option_words <- function(name, value, folder) {
  option <- paste0("--", gsub("[._]", "-", name))
  if (is.null(value) || isFALSE(value)) return(character())
  if (isTRUE(value)) return(option)
  words <- value_words(value, folder)
  if (length(words) == 0) character() else paste0(option, "=", words)
}

value_words <- function(value, folder) {
  if (is.null(value)) return(character())
  if (is.data.frame(value)) return(write_frame(value, folder))
  if (inherits(value, "formula")) return(paste(deparse(value, width.cutoff = 500), collapse = " "))
  if (is.list(value)) return(unlist(lapply(value, value_words, folder)))
  if (!is.character(value) && !is.numeric(value)) {
    stop("expected text, numbers, a formula or a data frame, found ", class(value)[[1]],
         call. = FALSE)
  }
  if (anyNA(value)) stop("expected a value, found NA", call. = FALSE)
  if (is.numeric(value)) number_text(value) else value
}

# All digits that a double has, and no more than it needs.
number_text <- function(value) {
  short <- sprintf("%.15g", value)
  finite <- is.finite(value)
  rounded <- finite
  rounded[finite] <- as.numeric(short[finite]) != value[finite]
  short[rounded] <- sprintf("%.17g", value[rounded])
  short
}

# A data frame as a file that the program reads. Cells without a value are blank.
write_frame <- function(frame, folder) {
  # Only columns of values can be columns of a table; others could not be named either.
  frame <- frame[vapply(frame, function(column) is.atomic(column) && is.null(dim(column)), NA)]
  if (ncol(frame) == 0) stop("the data frame has no column of numbers or texts", call. = FALSE)
  cells <- lapply(frame, function(column) {
    missing <- is.na(column)
    text <- if (is.numeric(column) && !is.factor(column)) number_text(as.numeric(column))
            else csv_text(as.character(column))
    ifelse(missing, "", text)
  })
  path <- file.path(folder, paste0(length(dir(folder)), ".csv"))
  rows <- do.call(paste, c(unname(cells), sep = ","))
  writeLines(enc2utf8(c(paste(csv_text(names(frame)), collapse = ","), rows)), path,
             useBytes = TRUE)
  path
}

csv_text <- function(text) paste0("\"", gsub("\"", "\"\"", text, fixed = TRUE), "\"")

# Messages do not name the files of data frames.
without_files <- function(text, folder) {
  for (path in dir(folder, pattern = "[.]csv$", full.names = TRUE)) {
    text <- gsub(path, "the data frame", text, fixed = TRUE)
  }
  text
}

# Numbers become vectors; what has keys stays a list.
from_json <- function(text) {
  if (!nzchar(text)) return(list())
  jsonlite::fromJSON(text, simplifyVector = TRUE, simplifyDataFrame = FALSE,
                     simplifyMatrix = FALSE)
}

with_messages <- function(result, messages) {
  if (!is.null(result)) attr(result, "messages") <- messages
  result
}

# The condition that the program failed: a wrong request (exit status 2) or failed work (1).
failure <- function(said, formatted) {
  lines <- lines_of(said$errors)
  # Of several errors the last one is that of the command itself.
  last <- tail(grep("^error: ", lines), 1)
  messages <- character()
  if (length(last) == 1) {
    messages <- lines[seq_len(last - 1)]
    lines <- sub("^error: ", "", lines[last:length(lines)])
  }
  text <- paste(c(lines, messages), collapse = "\n")
  if (!nzchar(text)) text <- paste("windfall ended with status", said$status)
  result <- NULL
  if (said$status == 1 && !formatted && nzchar(said$output)) result <- from_json(said$output)
  kind <- if (said$status == 2) "windfall_request" else "windfall_failed"
  structure(
    class = c(kind, "windfall_error", "error", "condition"),
    list(message = text, call = NULL, messages = messages, result = result)
  )
}
