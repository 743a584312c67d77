# Campaigns, recordings and tables.
library(windfall)

folder <- file.path(tempfile(), "a study")
dir.create(folder, recursive = TRUE)
study <- file.path(folder, "K\u00e4fer's fruit")
windfall("simulate", "pendulum", law = "kuwabara-kono(k=753599, c=1524)", recordings = study,
         specimens = 3, repeats = 2, spread = c("k=80000", "c=200"), encoder = "counts",
         rate = "100 kHz")

# A row for each impact and law, with the numbers of the JSON.
laws <- c("kuwabara-kono", "hertz")
fits <- wf_fit(study, law = laws)
json <- windfall("fit", study, law = laws)
stopifnot(nrow(fits) == 12, length(json$impacts) == 12, length(attr(fits, "messages")) > 0)
for (impact in json$impacts) {
  row <- fits[fits$id == impact$id & fits$law == impact$law, ]
  stopifnot(nrow(row) == 1, identical(row$converged, impact$converged))
  for (name in names(impact$parameters)) {
    parameter <- impact$parameters[[name]]
    stopifnot(
      identical(row[[name]], parameter$value),
      identical(row[[paste0(name, "_low")]], parameter$low),
      identical(row[[paste0(name, "_unit")]], parameter$unit)
    )
  }
  stopifnot(
    identical(row$peak_force_N, impact$derived$peak_force),
    identical(row$contact_duration_s, impact$derived$contact_duration)
  )
}

# Parquet has the same cells, where it can be read.
if (requireNamespace("nanoparquet", quietly = TRUE) || requireNamespace("arrow", quietly = TRUE)) {
  file <- file.path(folder, "fits.parquet")
  windfall("fit", study, law = laws, out = file, format = "text")
  columns <- wf_table(file)
  stopifnot(nrow(columns) == 12, all(names(fits) %in% names(columns)))
  for (name in names(fits)) {
    present <- !is.na(fits[[name]])
    stopifnot(
      identical(present, !is.na(columns[[name]])),
      all(fits[[name]][present] == columns[[name]][present])
    )
  }
}

# A recording of text: samples as in the file, units as its columns say.
file <- file.path(study, "raw", "specimen-01-01.csv")
recording <- wf_read(file)
plain <- utils::read.csv(file)
stopifnot(
  identical(names(recording), names(plain)),
  identical(as.numeric(recording$force_V), plain$force_V),
  identical(as.numeric(recording$count), as.numeric(plain$count)),
  identical(attr(recording$force_V, "units"), "V"),
  is.na(attr(recording$count, "units")),
  "no-time" %in% names(attr(recording, "findings"))
)

# A binary one, with times and the amplitude that 16 bits have.
taps <- file.path(folder, "taps")
windfall("simulate", "tap", taps, fruit = 1, taps = 1)
sound <- dir(file.path(taps, "raw"), full.names = TRUE)[[1]]
tap <- wf_read(sound)
bytes <- file.size(sound)
samples <- readBin(sound, "raw", bytes)
first <- readBin(utils::tail(samples, 2 * nrow(tap)), "integer", nrow(tap), 2, endian = "little")
stopifnot(
  identical(names(tap), c("time", "channel 1")),
  identical(attr(tap$time, "units"), "s"),
  identical(as.numeric(tap[["channel 1"]]), first / 32768),
  max(abs(diff(as.numeric(tap$time)) - 1 / 44100)) < 1e-12
)

# Designs have notes above their header; names that are numbers stay names.
design <- file.path(folder, "design.csv")
windfall("design", "factorial", factor = c("a=1..2", "b=x,y"), out = design, format = "text")
runs <- wf_table(design)
stopifnot(nrow(runs) == 4, setequal(runs$a, 1:2), setequal(runs$b, c("x", "y")))
writeLines(c("id,lot,ok,z", "1,007,true,1e-3", "2,008,false,"), design)
table <- wf_table(design)
stopifnot(
  identical(table$id, c("1", "2")), identical(table$lot, c("007", "008")),
  identical(table$ok, c(TRUE, FALSE)), identical(table$z, c(1e-3, NA))
)

# Recordings that end before the impact: a row is missing, and a message says why.
cut <- function(id) {
  file <- file.path(study, "raw", paste0(id, ".csv"))
  writeLines(utils::head(readLines(file), 50), file)
}
cut(json$impacts[[1]]$id)
fewer <- wf_fit(study, law = laws)
stopifnot(nrow(fewer) == 10, !any(fewer$id == json$impacts[[1]]$id))
stopifnot(any(grepl(json$impacts[[1]]$id, attr(fewer, "messages"))))

# Where none is left, laws cannot be compared: work that failed, not a wrong request.
for (id in unique(fewer$id)) cut(id)
failed <- tryCatch(windfall("laws", study), error = identity)
stopifnot(
  inherits(failed, "windfall_failed"), !inherits(failed, "windfall_request"),
  grepl("there is nothing to compare", conditionMessage(failed))
)
absent <- tryCatch(wf_fit(file.path(folder, "absent")), error = identity)
stopifnot(inherits(absent, "windfall_request"), grepl("campaign.toml", conditionMessage(absent)))
