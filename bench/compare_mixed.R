# Times lme4's lmer and windfall's mixed models in turns: see compare-mixed.
suppressMessages(library(lme4))
arguments <- commandArgs(trailingOnly = TRUE)
program <- arguments[1]
folder <- arguments[2]
rounds <- as.integer(arguments[3])
dir.create(folder, showWarnings = FALSE, recursive = TRUE)
set.seed(2013)

table_of <- function(group, other) {
  n <- length(group)
  x <- runif(n)
  own <- rnorm(max(group) + 1)
  slope <- rnorm(max(group) + 1)
  theirs <- rnorm(max(other) + 1)
  y <- 10 + 2 * x + 1.5 * own[group + 1] + 0.8 * slope[group + 1] * x + theirs[other + 1] + rnorm(n)
  data.frame(y = y, x = x, group = group, other = other)
}
ten <- rep(0:9999, each = 10)
models <- list(
  list(name = "10^4 groups of 10, intercept", model = "intercept",
    formula = y ~ x + (1 | group), data = table_of(ten, rep(0, 1e5))),
  list(name = "10^4 groups of 10, intercept and slope", model = "slope",
    formula = y ~ x + (1 + x | group), data = table_of(ten, rep(0, 1e5))),
  list(name = "10^4 groups of 10 in 500 groups", model = "both",
    formula = y ~ x + (1 | group) + (1 | other), data = table_of(ten, ten %/% 20)),
  list(name = "1000 groups crossed with 100", model = "both",
    formula = y ~ x + (1 | group) + (1 | other),
    data = table_of(rep(0:999, each = 100), rep(0:99, 1000)))
)
file <- file.path(folder, "mixed.csv")
# Writes the table and reads it back, so that both programs see the same numbers
written <- function(data) {
  write.table(lapply(data, format, digits = 15, trim = TRUE, scientific = FALSE), file,
    sep = ",", row.names = FALSE, col.names = FALSE, quote = FALSE)
  data <- read.csv(file, header = FALSE, col.names = names(data))
  data$group <- factor(data$group)
  data$other <- factor(data$other)
  data
}
criterion_of <- function(answer) as.numeric(strsplit(answer[1], " ")[[1]][3])
for (model in models) {
  data <- written(model$data)
  peer <- ours <- numeric(rounds)
  for (round in seq_len(rounds)) {
    gc()
    peer[round] <- system.time(fit <- lmer(model$formula, data))["elapsed"]
    answer <- system2(program, c(file, model$model), stdout = TRUE)
    ours[round] <- as.numeric(strsplit(answer[1], " ")[[1]][1])
  }
  criterion <- criterion_of(answer)
  cat(sprintf("%s: lme4 %.3f s, windfall %.4f s, ratio %.1f; criterion of lme4 higher by %.2g\n",
    model$name, median(peer), median(ours), median(peer) / median(ours), REMLcrit(fit) - criterion))
}

# Small tables, many with covariances on the edge of the parameter space
higher <- c(lme4 = 0, windfall = 0)
tables <- 300
for (index in seq_len(tables)) {
  groups <- sample(3:15, 1)
  n <- groups * sample(3:7, 1)
  group <- c(seq_len(groups), sample(groups, n - groups, TRUE))
  x <- runif(n) + sample(c(0, 0, 5), 1)
  y <- 5 + x + rnorm(groups)[group] * sample(c(0, 0.3, 2, 20), 1) +
    rnorm(groups)[group] * x * sample(c(0, 0.3, 3), 1) + rnorm(n)
  data <- written(data.frame(y = y, x = x, group = group - 1, other = 0))
  fit <- suppressMessages(suppressWarnings(lmer(y ~ x + (1 + x | group), data)))
  excess <- REMLcrit(fit) - criterion_of(system2(program, c(file, "slope"), stdout = TRUE))
  higher <- higher + c(excess > 1e-4, excess < -1e-4)
}
cat(sprintf("of %d small tables with slopes, the minimum is missed by more than 1e-4 in: lme4 %d, windfall %d\n",
  tables, higher[["lme4"]], higher[["windfall"]]))
