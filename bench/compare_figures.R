# The numbers beside the figures of `regress` and `compare`.
# Part of compare_statistics.R.
draw <- function(command, path, ...) {
  directory <- file.path(folder, "figures")
  unlink(directory, recursive = TRUE)
  stopifnot(system2(windfall, c(command, shQuote(path), ..., "--figures", shQuote(directory)), stdout = FALSE) == 0)
  function(name) read.csv(file.path(directory, paste0(name, ".csv")), check.names = FALSE)
}
path <- write_table("figures", fruit)
fit <- lm(k ~ variety * v + dose, fruit)
drawn <- draw("regress", path, "--formula", shQuote("k ~ variety * v + dose"), "--folds 0")
own <- drawn("diagnostics")
group <- "figures"
compare(group, "standardised residual", own$standardised, unname(rstandard(fit)), 1e-8)
compare(group, "leverage", own$leverage, unname(hatvalues(fit)), 1e-8)
compare(group, "Cook", own$cook, unname(cooks.distance(fit)), 1e-8)
scores <- qnorm(ppoints(nrow(fruit), a = 3 / 8))[rank(rstudent(fit))]
compare(group, "normal scores", own$normal_score, unname(scores), 1e-8)
compare(group, "expected studentised residual", own$expected, unname(qt(pnorm(scores), df.residual(fit) - 1)), 1e-8)
smooth <- function(x, y) {
  line <- lowess(x, y)
  line$y[match(rank(x, ties.method = "min"), rank(line$x, ties.method = "min"))]
}
compare(group, "lowess of residuals", 1 + own$smooth_residual, unname(1 + smooth(fitted(fit), resid(fit))), 1e-8)
compare(group, "lowess of their roots", own$smooth_root, unname(smooth(fitted(fit), sqrt(abs(rstandard(fit))))), 1e-8)
effects <- drawn("effects")
effects <- effects[effects$kind == "effect", ]
check_effect <- function(what, rows, expected) {
  expected <- as.data.frame(summary(expected))
  compare(group, what, c(rows$value, rows$low, rows$high), c(expected$emmean, expected$lower.CL, expected$upper.CL), 1e-8)
}
rows <- effects[effects$variable == "variety", ]
check_effect("effect of a category", rows, emmeans(fit, ~ variety | v, at = list(v = quantile(fruit$v, c(0.1, 0.5, 0.9))), data = fruit))
rows <- effects[effects$variable == "v", ]
check_effect("effect of a number", rows, emmeans(fit, ~ v | variety, at = list(v = unique(as.numeric(rows$at))), data = fruit))
rows <- effects[effects$variable == "dose", ]
check_effect("effect without partner", rows, emmeans(fit, ~ dose, data = fruit))
control <- lmerControl(optimizer = "bobyqa", optCtrl = list(rhobeg = 0.2, rhoend = 1e-10, maxfun = 1e5), calc.derivs = FALSE)
fit <- lme4::lmer(k ~ variety + dose + v + (1 | lot), fruit, REML = FALSE, control = control)
drawn <- draw("regress", path, "--formula", shQuote("k ~ variety + dose + v + (1 | lot)"), "--likelihood ml")
own <- drawn("random-effects")
expected <- as.data.frame(ranef(fit, condVar = TRUE))
expected <- expected[match(own$group, expected$grp), ]
compare(group, "effects of groups", own$value, expected$condval, 1e-5)
compare(group, "their deviations", own$sd, expected$condsd, 1e-5)
stopifnot(!is.unsorted(own$value))
compare(group, "scaled residual", 10 + drawn("diagnostics")$studentised, unname(10 + resid(fit) / sigma(fit)), 1e-5)
profile <- profile(fit, which = "theta_", signames = FALSE)
own <- drawn("profiles")
for (name in c("sd_(Intercept)|lot", "sigma")) {
  mine <- own[own$parameter == if (name == "sigma") "residual sd" else "sd of (Intercept), lot", ]
  expected <- predict(attr(profile, "forward")[[name]], mine$value)$y
  compare(group, paste("profile of", name), 10 + mine$signed_root, 10 + expected, 1e-3)
}
drawn <- draw("compare", path, "--value k --by variety")
own <- drawn("groups")
own <- own[own$kind == "mean", ]
expected <- vapply(split(fruit$k, fruit$variety), function(k) c(mean(k), t.test(k)$conf.int), numeric(3))
compare(group, "means of groups", c(own$value, own$low, own$high), c(t(expected)), 1e-8)
