# Tables, recordings and campaigns as data frames.

wf_table <- function(file) {
  switch(tolower(tools::file_ext(file)),
    parquet = read_parquet(file),
    arrow = ,
    feather = read_arrow(file),
    read_text(file)
  )
}

wf_fit <- function(campaign = ".", law = NULL, ...) {
  file <- tempfile("windfall-", fileext = ".csv")
  on.exit(unlink(file))
  said <- windfall("fit", campaign, law = law, ..., out = file, format = "csv")
  with_messages(wf_table(file), attr(said, "messages"))
}

wf_read <- function(recording, ...) {
  file <- tempfile("windfall-", fileext = ".csv")
  on.exit(unlink(file))
  said <- windfall("inspect", recording, ..., export = file)
  told <- said$files[[1]]
  frame <- read_text(file)

  # A unit stands in brackets behind a name, unless the file has it within the name.
  units <- vapply(told$columns, function(column) blank_if_null(column$unit), "")
  names(units) <- vapply(told$columns, function(column) column$column, "")
  parts <- split_unit(names(frame))
  for (place in seq_along(frame)) {
    unit <- parts$unit[[place]]
    if (is.na(unit)) unit <- unname(units[parts$name[[place]]])
    frame[[place]] <- as.numeric(frame[[place]])
    attr(frame[[place]], "units") <- unit
  }
  if (!anyDuplicated(parts$name)) names(frame) <- parts$name
  attr(frame, "format") <- told$format
  attr(frame, "findings") <- vapply(told$findings, function(finding) finding$message, "")
  names(attr(frame, "findings")) <- vapply(told$findings, function(finding) finding$code, "")
  frame
}

blank_if_null <- function(text) if (is.null(text)) NA_character_ else text

split_unit <- function(names) {
  pattern <- "^(.+) \\[([^][]*)\\]$"
  has <- grepl(pattern, names)
  list(name = ifelse(has, sub(pattern, "\\1", names), names),
       unit = ifelse(has, sub(pattern, "\\2", names), NA_character_))
}

# A table of text as windfall writes it: commas, points, UTF-8, and before its header
# perhaps lines that begin with "# ".
read_text <- function(file) {
  before <- 0
  for (line in readLines(file, n = 1000, warn = FALSE, encoding = "UTF-8")) {
    if (!startsWith(line, "#")) break
    before <- before + 1
  }
  frame <- read.csv(file, skip = before, colClasses = "character", na.strings = "",
                    check.names = FALSE, encoding = "UTF-8", comment.char = "",
                    strip.white = FALSE)
  texts <- names(frame) %in% text_columns | grepl("_unit$", names(frame))
  frame[!texts] <- lapply(frame[!texts], typed)
  frame
}

# Columns of names, which stay texts where all names happen to be numbers.
text_columns <- c("id", "specimen", "group", "file", "law", "findings", "simulated", "left_out",
                  "recording", "specimens", "impact")

# A column of numbers, of true and false, or of texts. "007" is a text.
typed <- function(cells) {
  given <- cells[!is.na(cells)]
  if (length(given) == 0) return(rep(NA_real_, length(cells)))
  if (all(given %in% c("true", "false"))) return(cells == "true")
  number <- "^-?(0|[1-9][0-9]*)([.][0-9]+)?([eE][-+]?[0-9]+)?$|^NaN$|^-?inf$"
  if (all(grepl(number, given))) return(as.numeric(cells))
  cells
}

read_parquet <- function(file) {
  if (requireNamespace("nanoparquet", quietly = TRUE)) {
    return(plain_frame(nanoparquet::read_parquet(file)))
  }
  if (requireNamespace("arrow", quietly = TRUE)) {
    return(plain_frame(arrow::read_parquet(file)))
  }
  stop("reading Parquet needs the package nanoparquet or arrow", call. = FALSE)
}

read_arrow <- function(file) {
  if (!requireNamespace("arrow", quietly = TRUE)) {
    stop("reading Arrow needs the package arrow", call. = FALSE)
  }
  plain_frame(arrow::read_feather(file))
}

plain_frame <- function(frame) as.data.frame(frame, check.names = FALSE, stringsAsFactors = FALSE)
