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
for (model in models) {
  file <- file.path(folder, "mixed.csv")
  write.table(lapply(model$data, format, digits = 15, trim = TRUE, scientific = FALSE), file,
    sep = ",", row.names = FALSE, col.names = FALSE, quote = FALSE)
  data <- read.csv(file, header = FALSE, col.names = names(model$data))
  data$group <- factor(data$group)
  data$other <- factor(data$other)
  peer <- ours <- numeric(rounds)
  for (round in seq_len(rounds)) {
    gc()
    peer[round] <- system.time(fit <- lmer(model$formula, data))["elapsed"]
    answer <- system2(program, c(file, model$model), stdout = TRUE)
    ours[round] <- as.numeric(strsplit(answer[1], " ")[[1]][1])
  }
  criterion <- as.numeric(strsplit(answer[1], " ")[[1]][3])
  cat(sprintf("%s: lme4 %.3f s, windfall %.4f s, ratio %.1f; criterion of lme4 higher by %.2g\n",
    model$name, median(peer), median(ours), median(peer) / median(ours), REMLcrit(fit) - criterion))
}
