# Response surfaces of runs in random groups against lme4 and pbkrtest: split-plot designs as
# windfall makes them, whole and with runs lost, days, whole plots within days.
# Part of compare_statistics.R.

# factors: names; groups: columns of the groups, the inner ones within the outer.
check_groups <- function(group, table, factors, terms, groups) {
  path <- write_table(group, table)
  nested <- Reduce(function(a, b) paste0(a, "/", b), groups)
  options <- paste(paste0("--factor ", factors, " --range ", factors, "=-1..1"), collapse = " ")
  output <- system2(windfall, c("surface", shQuote(path), "--response y", options, "--model", shQuote(terms), "--random", nested,
                                "--grid", paste(factors[1:2], collapse = ","), "--grid-points 3 --format json"), stdout = TRUE)
  found <- fromJSON(paste(output, collapse = "\n"))
  right <- gsub("([A-Za-z0-9]+)\\^2", "I(\\1^2)", terms)
  control <- lmerControl(optimizer = "bobyqa", optCtrl = list(rhoend = 1e-10, maxfun = 1e5))
  fit <- lmer(as.formula(paste("y ~", right, "+ (1 |", nested, ")")), table, control = control)
  # Their columns in the order of the terms as written.
  written <- gsub(" ", "", strsplit(terms, "+", fixed = TRUE)[[1]])
  wanted <- c("(Intercept)", gsub("([A-Za-z0-9]+)\\^2", "I(\\1^2)", written))
  place <- match(wanted, names(fixef(fit)))
  stopifnot(!anyNA(place))
  adjusted <- vcovAdj(as(fit, "lmerMod"))
  beta <- unname(fixef(fit))
  se <- sqrt(diag(as.matrix(adjusted)))
  p <- length(beta)
  df <- vapply(1:p, function(i) Lb_ddf(as.numeric(1:p == i), vcov(fit), adjusted), 0)
  limit <- 1e-5
  compare(group, "coefficient", found$terms$coded, beta[place], limit)
  compare(group, "standard error", found$terms$se, se[place], limit)
  # Ends near zero are compared by the width, variances that vanish by the scatter of the runs.
  half <- (qt(0.975, df) * se)[place]
  compare(group, "interval", 1 + c(found$terms$low, found$terms$high) / half, 1 + c(beta[place] - half, beta[place] + half) / half, limit)
  compare(group, "F", found$terms$f[-1], ((beta / se)^2)[place][-1], limit)
  compare(group, "degrees of freedom", found$terms$df_denominator[-1], df[place][-1], limit)
  compare(group, "p", found$terms$p[-1], pf(((beta / se)^2), 1, df, lower.tail = FALSE)[place][-1], limit)
  whole <- KRmodcomp(as(fit, "lmerMod"), cbind(0, diag(p - 1)))$test["Ftest", ]
  compare(group, "model", c(found$model$f, found$random$model_df_denominator, found$model$p), c(whole$stat, whole$ddf, whole$p.value), 1e-4)
  variances <- as.data.frame(VarCorr(fit))
  own <- found$random$variances
  compare(group, "standard deviations", 1 + own$value / sigma(fit), 1 + variances$sdcor[match(sorted(own$group), sorted(sub("Residual", "residual", variances$grp)))] / sigma(fit), limit)
  compare(group, "log-likelihood", found$log_likelihood, as.numeric(logLik(fit)), limit)
  grid <- as.data.frame(found$grid$rows)
  names(grid) <- found$grid$columns
  at <- grid[factors]
  rows <- model.matrix(as.formula(paste("~", right)), at)
  compare(group, "prediction", grid$y, as.numeric(rows %*% beta), limit)
  compare(group, "error of prediction", grid$y_se, sqrt(rowSums((rows %*% as.matrix(adjusted)) * rows)), limit)
}

# Names of nested groups in one order: a:b is b:a.
sorted <- function(groups) vapply(strsplit(groups, ":"), function(own) paste(sort(own), collapse = ":"), "")

split_plot <- function(options) {
  path <- tempfile(fileext = ".csv")
  system2(windfall, c("design split-plot", options, "--out", shQuote(path), "--format csv"), stdout = FALSE, stderr = FALSE)
  read.csv(path, comment.char = "#")
}

set.seed(28)
own <- split_plot("--factor T=-1..1 --factor h=-1..1 --factor m=-1..1 --hard T --whole-plots 10 --runs 40")
own$y <- with(own, 12 + 1.5 * T - h + 0.7 * m + 0.9 * T * h - 1.1 * h^2 + rnorm(10, 0, 0.8)[whole_plot] + rnorm(40, 0, 0.5))
quadratic <- "T + h + m + T:h + T:m + h:m + T^2 + h^2 + m^2"
check_groups("split-plot, one hard factor", own, c("T", "h", "m"), quadratic, "whole_plot")
check_groups("split-plot, runs lost", own[-c(3, 11, 12, 13, 29, 40), ], c("T", "h", "m"), quadratic, "whole_plot")

own <- split_plot("--factor T=-1..1 --factor h=-1..1 --factor m=-1..1 --factor v=-1..1 --hard T --hard v --whole-plots 9 --runs 31 --model 2fi --seed 4")
own$y <- with(own, 3 + 0.4 * T - 0.3 * v + 0.2 * m * v + rnorm(9, 0, 0.2)[whole_plot] + rnorm(31, 0, 0.3))
check_groups("split-plot, two hard factors, plots of two sizes", own, c("T", "h", "m", "v"), "T + h + m + v + T:h + T:v + m:v", "whole_plot")

own <- split_plot("--factor T=-1..1 --factor h=-1..1 --hard T --whole-plots 12 --runs 36 --criterion i --ratio 3 --seed 7")
own$day <- paste0("day", (own$whole_plot + 2) %/% 3)
own$y <- with(own, 20 + 2 * T - h + T^2 + rnorm(4, 0, 2)[(whole_plot + 2) %/% 3] + rnorm(12, 0, 1)[whole_plot] + rnorm(36, 0, 0.7))
check_groups("whole plots within days", own, c("T", "h"), "T + h + T:h + T^2 + h^2", c("day", "whole_plot"))

ccd <- expand.grid(A = c(-1, 1), B = c(-1, 1), C = c(-1, 1))
ccd <- rbind(ccd, cbind(A = c(-1, 1, 0, 0, 0, 0), B = c(0, 0, -1, 1, 0, 0), C = c(0, 0, 0, 0, -1, 1)), matrix(0, 6, 3, dimnames = list(NULL, c("A", "B", "C"))))
ccd <- rbind(ccd, ccd)
ccd$day <- rep(letters[1:5], 8)
ccd$y <- with(ccd, 8 + A - B + 0.5 * A * B - A^2 + rnorm(5)[match(day, letters)] + rnorm(40, 0, 0.6))
check_groups("composite design over five days", ccd, c("A", "B", "C"), "A + B + C + A:B + A:C + B:C + A^2 + B^2 + C^2", "day")
