# Runs R and windfall on the same tables and prints the largest relative difference
# of every quantity; stops with an error if one exceeds its limit.
#
# Usage: Rscript compare_statistics.R WINDFALL FOLDER

suppressMessages({
  library(car); library(MASS); library(lme4); library(lmerTest); library(pbkrtest); library(jsonlite); library(emmeans)
})
arguments <- commandArgs(trailingOnly = TRUE)
windfall <- arguments[1]
folder <- arguments[2]
dir.create(folder, showWarnings = FALSE, recursive = TRUE)
worst <- list()

write_table <- function(name, table) {
  path <- file.path(folder, paste0(name, ".csv"))
  numbers <- vapply(table, is.numeric, TRUE)
  table[numbers] <- lapply(table[numbers], function(x) sprintf("%.17g", x))
  write.csv(table, path, row.names = FALSE, quote = FALSE)
  path
}

ask <- function(path, ...) {
  output <- system2(windfall, c("regress", shQuote(path), ..., "--format", "json"), stdout = TRUE)
  fromJSON(paste(output, collapse = "\n"))
}

# Vanishing probabilities are not compared.
compare <- function(group, what, found, expected, limit) {
  stopifnot(length(found) == length(expected))
  scale <- pmax(abs(expected), 1e-12 * max(abs(expected), na.rm = TRUE))
  difference <- max(abs(found - expected) / scale, na.rm = TRUE)
  stopifnot(!any(is.na(found) != is.na(expected)))
  key <- paste(group, what, sep = ": ")
  worst[[key]] <<- c(difference, limit)
}

# The columns are in the same order, so R's column names need no translation.
check_linear <- function(group, path, formula, table, arguments = character()) {
  fit <- lm(formula, table)
  found <- ask(path, "--formula", shQuote(paste(deparse(formula, width.cutoff = 500), collapse = "")), "--folds 0", arguments)
  own <- summary(fit)
  limit <- 1e-8
  compare(group, "estimate", found$terms$estimate, unname(own$coefficients[, 1]), limit)
  compare(group, "standard error", found$terms$se, unname(own$coefficients[, 2]), limit)
  compare(group, "t", found$terms$t, unname(own$coefficients[, 3]), limit)
  compare(group, "p", found$terms$p, unname(own$coefficients[, 4]), limit)
  interval <- confint(fit)
  compare(group, "interval", c(found$terms$low, found$terms$high), unname(c(interval)), limit)
  compare(group, "R2 and adjusted", c(found$r2, found$r2_adjusted), c(own$r.squared, own$adj.r.squared), limit)
  h <- hatvalues(fit)
  press <- sum((resid(fit) / (1 - h))^2)
  compare(group, "PRESS", found$press, press, limit)
  compare(group, "AIC, BIC, log-likelihood", c(found$aic, found$bic, found$log_likelihood), c(AIC(fit), BIC(fit), as.numeric(logLik(fit))), limit)
  compare(group, "leverage", found$influence$leverage, unname(h), limit)
  compare(group, "standardised residual", found$influence$standardised, unname(rstandard(fit)), limit)
  compare(group, "studentised residual", found$influence$studentised, unname(rstudent(fit)), limit)
  compare(group, "Cook", found$influence$cook, unname(cooks.distance(fit)), limit)
  compare(group, "DFFITS", found$influence$dffits, unname(dffits(fit)), limit)
  factors <- vif(fit)
  compare(group, "VIF", found$vif$factor, unname(if (is.matrix(factors)) factors[, 1] else factors), limit)
  robust <- ask(path, "--formula", shQuote(paste(deparse(formula, width.cutoff = 500), collapse = "")), "--folds 0 --robust")
  compare(group, "HC3", robust$terms$se, unname(sqrt(diag(hccm(fit, type = "hc3")))), limit)
  for (type in 1:3) {
    coded <- if (type == 3) list(contrasts = c("contr.sum", "contr.poly")) else list()
    expected <- if (type == 1) anova(fit) else if (type == 2) Anova(fit, type = 2) else {
      old <- options(contrasts = c("contr.sum", "contr.poly"))
      summed <- lm(formula, table)
      result <- Anova(summed, type = 3)
      options(old)
      result[-1, ]
    }
    answer <- ask(path, "--formula", shQuote(paste(deparse(formula, width.cutoff = 500), collapse = "")), "--folds 0", paste("--anova", type))
    rows <- seq_len(nrow(expected) - 1)
    ss <- expected[["Sum Sq"]]
    f <- if (type == 1) expected[["F value"]] else expected[["F value"]]
    compare(group, paste("ANOVA", type, "SS"), c(answer$anova$ss, answer$residual$ss), ss, limit)
    compare(group, paste("ANOVA", type, "F"), answer$anova$f, f[rows], limit)
    compare(group, paste("ANOVA", type, "p"), answer$anova$p, expected[["Pr(>F)"]][rows], limit)
  }
  new <- table[seq_len(5), , drop = FALSE]
  path_new <- write_table(paste0(group, " new"), new)
  answer <- ask(path, "--formula", shQuote(paste(deparse(formula, width.cutoff = 500), collapse = "")), "--folds 0 --predict", shQuote(path_new))
  mean_interval <- predict(fit, new, interval = "confidence")
  interval <- predict(fit, new, interval = "prediction")
  compare(group, "prediction", c(answer$predictions$predicted, answer$predictions$mean_low, answer$predictions$high),
    unname(c(mean_interval[, 1], mean_interval[, 2], interval[, 3])), limit)
}

set.seed(7)
velocity <- rep(c(0.1, 0.3, 0.5, 0.7), 25)
apple <- data.frame(
  V = velocity + runif(100, -0.02, 0.02), R = runif(100, 0.03, 0.07),
  t = 0.008 - 0.004 * velocity + rnorm(100, 0, 2e-4), S = rnorm(100, 24, 3)
)
apple$k <- 7e5 - 3.3e5 * apple$V + 2.9e5 * apple$R + 3.4e7 * apple$t + rnorm(100, 0, 1.2e4)
path <- write_table("apple", apple)
check_linear("apple", path, k ~ V * R + t + S, apple)
check_linear("apple log", path, log(k) ~ poly(V, 2) + R + I(t^2) + sqrt(S), apple)

fruit <- data.frame(
  variety = sample(c("Gala", "Fuji", "Golden"), 70, TRUE, c(0.5, 0.3, 0.2)),
  ripe = sample(c("no", "yes"), 70, TRUE), mass = rnorm(70, 0.18, 0.02)
)
fruit$firmness <- 60 - 8 * (fruit$ripe == "yes") + 4 * (fruit$variety == "Fuji") + 90 * fruit$mass + rnorm(70, 0, 3)
path <- write_table("fruit", fruit)
check_linear("fruit", path, firmness ~ variety * ripe + mass, fruit)

# Backward by BIC, in the order of R's step(), which keeps hierarchy.
path <- file.path(folder, "apple.csv")
fit <- lm(k ~ (V + R + t + S)^2, apple)
steps <- step(fit, direction = "backward", k = log(100), trace = 0)
answer <- ask(path, "--response k --terms", shQuote("(V + R + t + S)^2"), "--select backward --criterion bic --hierarchy --folds 0")
removed <- sub("^- ", "", as.character(steps$anova$Step[-1]))
stopifnot(identical(answer$removed$term, removed))
compare("selection", "estimates after backward BIC", answer$terms$estimate, unname(coef(steps)), 1e-8)

# Mixed models: days of 18 subjects, and fruit struck at four velocities.
days <- expand.grid(day = 0:9, subject = sprintf("s%02d", 1:18))
subject <- as.integer(days$subject)
days$y <- 250 + rnorm(18, 0, 25)[subject] + (10 + rnorm(18, 0, 6)[subject]) * days$day + rnorm(180, 0, 25)
impacts <- expand.grid(V = c(0.1, 0.3, 0.5, 0.7), specimen = sprintf("a%02d", 1:20))
more <- data.frame(V = rep(c(0.1, 0.7), each = 10), specimen = sprintf("b%02d", 1:20))
impacts <- rbind(impacts, more)
place <- as.integer(factor(impacts$specimen))
impacts$R <- runif(40, 0.03, 0.07)[place]
impacts$variety <- c("Red", "Golden")[1 + place %% 2]
impacts$k <- 1e6 - 3e5 * impacts$V + 3e5 * impacts$R + 2e4 * (impacts$variety == "Red") + rnorm(40, 0, 6e4)[place] + rnorm(100, 0, 3e4)

check_mixed <- function(group, table, formula, maximum = FALSE, joint = 1e-5) {
  path <- write_table(group, table)
  control <- lmerControl(optimizer = "bobyqa", optCtrl = list(rhobeg = 0.2, rhoend = 1e-10, maxfun = 1e5), calc.derivs = FALSE)
  fit <- lmerTest::lmer(formula, table, REML = !maximum, control = control)
  text <- shQuote(paste(deparse(formula, width.cutoff = 500), collapse = ""))
  likelihood <- if (maximum) "--likelihood ml" else "--likelihood reml"
  found <- ask(path, "--formula", text, likelihood)
  own <- coef(summary(fit))
  limit <- 1e-5
  compare(group, "estimate", found$terms$estimate, unname(own[, "Estimate"]), limit)
  compare(group, "standard error", found$terms$se, unname(own[, "Std. Error"]), limit)
  compare(group, "Satterthwaite df", found$terms$df, unname(own[, "df"]), limit)
  compare(group, "criterion", c(found$criterion, found$aic, found$bic), c(-2 * as.numeric(logLik(fit)), AIC(fit), BIC(fit)), limit)
  # Nested groups are named from the inside in R: "plot:block".
  inner <- function(names) vapply(strsplit(as.character(names), ":"), function(own) paste(sort(own), collapse = ":"), "")
  variances <- as.data.frame(VarCorr(fit))
  variances <- variances[order(match(inner(variances$grp), c(inner(unique(found$effects$by)), "Residual"))), ]
  correlations <- !is.na(variances$var2)
  compare(group, "standard deviations", found$variances$value[found$variances$kind == "sd"], variances$sdcor[!correlations], limit)
  if (any(correlations)) compare(group, "correlations", found$variances$value[found$variances$kind == "correlation"], variances$sdcor[correlations], limit)
  tests <- anova(fit, type = 3)
  compare(group, "F", found$anova$f, tests[["F value"]], limit)
  compare(group, "p of F", found$anova$p, tests[["Pr(>F)"]], joint)
  effects <- as.data.frame(ranef(fit, condVar = TRUE))
  names <- inner(unique(found$effects$group))
  effects <- effects[order(match(inner(effects$grp), names), effects$term), ]
  mine <- found$effects[order(match(inner(found$effects$group), names), factor(found$effects$of, levels = levels(effects$term))), ]
  compare(group, "effects of groups", mine$value, effects$condval, 1e-4)
  compare(group, "their deviations", mine$sd, effects$condsd, limit)
  if (!maximum) {
    answer <- ask(path, "--formula", text, "--df kenward-roger")
    adjusted <- coef(summary(fit, ddf = "Kenward-Roger"))
    compare(group, "Kenward-Roger se", answer$terms$se, unname(adjusted[, "Std. Error"]), limit)
    compare(group, "Kenward-Roger df", answer$terms$df, unname(adjusted[, "df"]), limit)
  }
  # R profiles the plain likelihood, windfall that of the fit: they agree on fits by
  # maximum likelihood.
  if (maximum) {
    profile <- suppressMessages(suppressWarnings(confint(fit, method = "profile", oldNames = FALSE, parm = "theta_", devtol = 1e-9)))
    order <- c(grep("^sd", rownames(profile)), grep("^sigma", rownames(profile)))
    sds <- found$variances[found$variances$kind == "sd", ]
    compare(group, "profile intervals", c(sds$low, sds$high), unname(c(profile[order, ])), 1e-3)
  }
}
check_mixed("days", days, y ~ day + (1 + day | subject))
check_mixed("days by ML", days, y ~ day + (1 + day | subject), TRUE)
check_mixed("impacts", impacts, k ~ V * variety + R + (1 | specimen))
check_mixed("impacts by ML", impacts, k ~ V + R + (1 | specimen), TRUE)

# Split-plots, in which whole plots have an error of their own: two published ones, of lme4 and nlme
# (cakes of three recipes baked at six temperatures; oats of three varieties with four amounts of
# nitrogen), and one with missing plots.
cake <- transform(as.data.frame(lme4::cake), recipe = as.character(recipe), replicate = paste0("r", replicate))[c("angle", "recipe", "temp", "replicate")]
check_mixed("split-plot of cakes", cake, angle ~ recipe * temp + (1 | recipe:replicate))
oats <- data.frame(yield = nlme::Oats$yield, nitro = nlme::Oats$nitro, variety = as.character(nlme::Oats$Variety), block = as.character(nlme::Oats$Block))
check_mixed("split-plot of oats", oats, yield ~ variety + nitro + (1 | block / variety))
plots <- expand.grid(sub = paste0("s", 1:4), whole = paste0("w", 1:3), day = paste0("d", 1:5))
plots$x <- signif(runif(60), 4)
plots$y <- signif(10 + as.integer(plots$sub) + 2 * as.integer(plots$whole) + plots$x + 3 * c(-1.2, 0.4, 1.5, -0.3, -0.6)[plots$day] + rnorm(15, sd = 1.5)[interaction(plots$whole, plots$day)] + rnorm(60), 6)
plots <- plots[-c(2, 7, 8, 21, 40, 41, 42, 60), ]
plots[c("sub", "whole", "day")] <- lapply(plots[c("sub", "whole", "day")], as.character)
# Satterthwaite's degrees of freedom of several contrasts depend on which independent ones are
# taken: lmerTest takes others than the sum coding, which matters where plots are missing.
check_mixed("split-plot with missing plots", plots, y ~ sub * whole + x + (1 | day / whole), joint = 1e-3)

source("bench/compare_means.R")
source("bench/compare_variances.R")

# Central composite designs in blocks, as windfall makes them: `surface` against lm with the
# block, pure error from rows with equal settings within a block.
check_blocks <- function(group, factors, options) {
  path <- file.path(folder, paste0(group, ".csv"))
  unlink(path)
  names <- letters[seq_len(factors)]
  ranges <- paste("--factor", shQuote(paste0(names, "=", seq_len(factors), "..", 2 * seq_len(factors) + 1)))
  stopifnot(system2(windfall, c("design ccd", ranges, options, "--seed 5 --out", shQuote(path)), stdout = FALSE) == 0)
  header <- grep("^#", readLines(path), value = TRUE)
  table <- read.csv(path, comment.char = "#")
  coded <- as.matrix(table[paste0(names, "_coded")])
  day <- rnorm(max(table$block), sd = 3)
  table$y <- signif(20 + day[table$block] + coded %*% seq_len(factors) - 1.3 * rowSums(coded^2) + coded[, 1] * coded[, 2] + rnorm(nrow(table)), 6)
  writeLines(c(header, capture.output(write.csv(table, row.names = FALSE, quote = FALSE))), path)
  output <- system2(windfall, c("surface", shQuote(path), "--response y --anova 1 --format json"), stdout = TRUE)
  found <- fromJSON(paste(output, collapse = "\n"))$responses
  names(table)[match(paste0(names, "_coded"), names(table))] <- LETTERS[seq_len(factors)]
  pairs <- combn(LETTERS[seq_len(factors)], 2, paste, collapse = ":")
  terms <- c(LETTERS[seq_len(factors)], pairs, paste0("I(", LETTERS[seq_len(factors)], "^2)"))
  table$block <- factor(table$block)
  fit <- lm(reformulate(c("block", terms), "y", env = environment()), table, contrasts = list(block = "contr.sum"))
  own <- summary(fit)$coefficients
  mine <- c("(Intercept)", terms)
  limit <- 1e-8
  compare(group, "estimate", found$terms[[1]]$coded, unname(coef(fit)[match(mine, reorder_names(names(coef(fit)), mine))]), limit)
  compare(group, "standard error", found$terms[[1]]$se, unname(own[match(mine, reorder_names(rownames(own), mine)), 2]), limit)
  compare(group, "residual SS", found$residual$ss, sum(resid(fit)^2), limit)
  compare(group, "block SS", found$blocks$ss, anova(fit)["block", "Sum Sq"], limit)
  compare(group, "model SS", found$model$ss, anova(lm(y ~ block, table), fit)[2, "Sum of Sq"], limit)
  key <- interaction(table$block, do.call(paste, as.data.frame(round(coded, 9))), drop = TRUE)
  pure <- sum((table$y - ave(table$y, key))^2)
  compare(group, "pure error SS", found$lack_of_fit$pure_error$ss, pure, limit)
  effects <- c(coef(fit)[grep("^block", names(coef(fit)))])
  compare(group, "blocks", found$blocks$effects[[1]]$effect, unname(c(effects, -sum(effects))), limit)
}
reorder_names <- function(found, wanted) {
  # R may write an interaction the other way round.
  turned <- vapply(strsplit(found, ":"), function(own) paste(rev(own), collapse = ":"), "")
  ifelse(turned %in% wanted, turned, found)
}
check_blocks("ccd of 2 in 2 blocks", 2, "--blocks 2")
check_blocks("ccd of 3 in 2 blocks", 3, "--blocks 2")
check_blocks("ccd of 3 in 3 blocks", 3, "--blocks 3")
check_blocks("ccd of 4 in 3 blocks", 4, "--blocks 3")
check_blocks("ccd of 5 in 5 blocks", 5, "--blocks 5")

source("bench/compare_surfaces.R")
source("bench/compare_figures.R")
source("bench/compare_plan.R")

values <- do.call(rbind, worst)
colnames(values) <- c("difference", "limit")
cat(sprintf("%-52s %10s %8s\n", "", "largest", "limit"))
for (key in rownames(values)) cat(sprintf("%-52s %10.1e %8.0e%s\n", key, values[key, 1], values[key, 2], if (values[key, 1] > values[key, 2]) "  BEYOND" else ""))
beyond <- sum(values[, 1] > values[, 2])
cat(sprintf("%d quantities, %d beyond their limit; R %s, lme4 %s\n", nrow(values), beyond, getRversion(), packageVersion("lme4")))
quit(status = if (beyond > 0) 1 else 0)
