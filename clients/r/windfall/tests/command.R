# How the program is found and called, and what it says when it fails.
library(windfall)

caught <- function(call) tryCatch(call, error = identity)
# A folder with blanks, quotation marks and umlauts in its name; Windows allows no double ones.
marks <- if (.Platform$OS.type == "windows") "it's $HOME" else "it's \"$HOME\" `a`"
folder <- file.path(tempfile(), paste(marks, "f\u00fcnf"))
dir.create(folder, recursive = TRUE)

# Results are lists; numbers are those of the program, to the last digit.
impact <- windfall("simulate", "impact", law = "kuwabara-kono(k=753599, c=1524)",
                   mass = "0.2 kg", velocity = "0.5 m/s")
typed <- windfall("simulate", "impact", "--law", "kuwabara-kono(k=753599, c=1524)",
                  "--mass", "0.2 kg", "--velocity=0.5 m/s", format = "csv")
columns <- strsplit(typed[[1]], ",")[[1]]
values <- strsplit(typed[[2]], ",")[[1]]
stopifnot(
  is.list(impact), is.character(typed),
  identical(impact$peak_force, as.numeric(values[columns == "peak_force_N"]))
)

# Commands that have no JSON return what they print.
stopifnot(any(grepl("_windfall()", windfall("completions", "bash"), fixed = TRUE)))

# Names and cells that are code elsewhere come through as they are.
names <- c("a b", "it's", "\"quoted\"", "k\u00e4se", "a,b", "$HOME", "back\\slash", "100%")
frame <- data.frame(value = c(0.1 + 0.2, 1/3, 1e-300, 2, 3, 4, 5, NA), x = names,
                    check.names = FALSE)
names(frame)[2] <- "which \u00e4 'one'"
said <- windfall("summary", frame, value = "value", by = names(frame)[2])
groups <- said$values[[1]]$groups
found <- vapply(groups, function(group) group$group, "")
means <- lapply(groups, function(group) group$mean)
stopifnot(
  setequal(found, names),
  identical(means[[match("a b", found)]], 0.1 + 0.2),
  identical(means[[match("it's", found)]], 1/3),
  identical(means[[match("\"quoted\"", found)]], 1e-300),
  is.null(means[[match("100%", found)]])
)

# Files, too.
file <- file.path(folder, "a b.csv")
writeLines(enc2utf8("v,k\n1,2\n2,3.5\n3,4.1\n4,6"), file, useBytes = TRUE)
stopifnot(all.equal(windfall("regress", file, formula = k ~ v)$terms[[2]]$estimate, 1.26))

# A wrong request has the words of the command.
wrong <- caught(windfall("regress", file, formula = "k ~ speed"))
stopifnot(
  inherits(wrong, "windfall_request"), inherits(wrong, "windfall_error"),
  grepl("there is no column \"speed\"; the table has v, k", conditionMessage(wrong), fixed = TRUE)
)
wrong <- caught(windfall("summary", data.frame(a = 1:3), value = "b"))
stopifnot(startsWith(conditionMessage(wrong), "the data frame: there is no column \"b\""))

# Options: several values, flags, and what is left out.
words <- windfall:::option_words
stopifnot(
  identical(words("p_remove", 0.1, folder), "--p-remove=0.1"),
  identical(words("spread", c("k=1", "c=2"), folder), c("--spread=k=1", "--spread=c=2")),
  identical(words("robust", TRUE, folder), "--robust"),
  identical(words("robust", FALSE, folder), character()),
  identical(words("law", NULL, folder), character()),
  identical(words("x", 0.1 + 0.2, folder), "--x=0.30000000000000004"),
  grepl("found NA", conditionMessage(caught(words("x", NA_character_, folder))))
)

# Words for Windows, whose rule is that of CommandLineToArgvW.
quoted <- function(word) windfall:::quote_word(word, windows = TRUE)
stopifnot(
  identical(quoted("a b"), "\"a b\""),
  identical(quoted("C:\\folder\\"), "\"C:\\folder\\\\\""),
  identical(quoted("say \"no\""), "\"say \\\"no\\\"\""),
  identical(quoted("back\\\"slash"), "\"back\\\\\\\"slash\"")
)

# Where there is no program, it is said how to name it.
kept <- Sys.getenv(c("PATH", "WINDFALL"))
options(windfall.command = file.path(folder, "absent"))
absent <- conditionMessage(caught(windfall("card", "show")))
stopifnot(grepl("there is no program", absent), grepl("windfall.command", absent, fixed = TRUE))
options(windfall.command = NULL)
Sys.setenv(WINDFALL = file.path(folder, "absent"))
absent <- conditionMessage(caught(windfall("card", "show")))
stopifnot(grepl("environment variable WINDFALL names", absent))
Sys.setenv(PATH = "", WINDFALL = "")
absent <- conditionMessage(caught(windfall("card", "show")))
stopifnot(grepl("not on the search path", absent))
do.call(Sys.setenv, as.list(kept))
