# Part of compare_statistics.R.
# Plans: power and half-widths against R's own functions, and against integrals for Welch's test.
ask_plan <- function(...) {
  output <- system2(windfall, c("plan", ..., "--format", "json"), stdout = TRUE)
  fromJSON(paste(output, collapse = "\n"))$rows
}
check_power <- function(what, line, expected, limit = 1e-6) {
  compare("plan", what, ask_plan(line)$power$value, expected, limit)
}
for (n in c(2, 5, 20, 300)) for (sides in c("two.sided", "one.sided")) {
  one <- if (sides == "one.sided") "--one-sided" else ""
  for (type in c("one.sample", "two.sample", "paired")) {
    line <- switch(type, one.sample = "mean", two.sample = "difference --pooled", paired = "difference --same-fruit")
    own <- power.t.test(n = n, delta = 0.7, sd = 1.3, type = type, alternative = sides, strict = sides == "two.sided")
    check_power(paste(type, n, sides), paste(line, "--difference 0.7 --sd 1.3", one, "--fruit", n), own$power)
  }
}
for (k in c(2, 4)) {
  means <- c(10, 11, 13, 10.5)[seq_len(k)]
  own <- power.anova.test(groups = k, n = 7, between.var = var(means), within.var = 4)
  check_power(paste("groups", k), paste("groups --sd 2 --fruit 7 --means", paste(means, collapse = ",")), own$power)
}
# Fruit means in a balanced mixed model.
for (m in c(1, 4)) {
  sd <- sqrt(0.04 + 0.01 / m)
  own <- power.t.test(power = 0.8, delta = 0.15, sd = sd, strict = TRUE)
  rows <- ask_plan("difference --difference 0.15 --between 0.2 --within 0.1 --power 0.8 --impacts", m)
  compare("plan", paste("smallest number of fruit,", m, "impacts"), rows$fruit, ceiling(own$n), 0)
}
# Welch's test from its definition: over both sums of squares.
welch_power <- function(sd, n, delta, alpha = 0.05) {
  df <- n - 1
  top <- function(k) qchisq(1e-14, df[k], lower.tail = FALSE)
  given <- function(a, b) {
    own <- sd^2 * c(a, b) / df / n
    critical <- qt(1 - alpha / 2, sum(own)^2 / sum(own^2 / df)) * sqrt(sum(own))
    error <- sqrt(sum(sd^2 / n))
    pnorm((delta - critical) / error) + pnorm((-delta - critical) / error)
  }
  inner <- function(a) integrate(function(b) vapply(b, function(b) given(a, b), 0) * dchisq(b, df[2]), 0, top(2), rel.tol = 1e-9, subdivisions = 500)$value
  integrate(function(a) vapply(a, inner, 0) * dchisq(a, df[1]), 0, top(1), rel.tol = 1e-9, subdivisions = 500)$value
}
check_power("Welch 10, 15", "difference --difference 1.5 --sd 1,2 --fruit 10 --ratio 1.5", welch_power(c(1, 2), c(10, 15), 1.5))
check_power("Welch 4, 12", "difference --difference 2 --sd 3,1 --fruit 4 --ratio 3", welch_power(c(3, 1), c(4, 12), 2))
for (n in c(3, 30)) {
  own <- qt(0.975, n - 1) * 12 / sqrt(n) * sqrt(2 / (n - 1)) * exp(lgamma(n / 2) - lgamma((n - 1) / 2))
  compare("plan", paste("half-width", n), ask_plan("mean --sd 12 --fruit", n)$half_width, own, 1e-8)
  own <- qt(0.975, n - 1) * 12 / sqrt(n) * sqrt(qchisq(0.9, n - 1) / (n - 1))
  compare("plan", paste("half-width with assurance", n), ask_plan("mean --sd 12 --assurance 0.9 --fruit", n)$half_width, own, 1e-8)
}

# As simr does: 300 studies drawn from lme4's fit, fitted and tested by lmerTest; side by side with
# windfall's simulation, within four errors of their difference.
pilot <- expand.grid(V = c(0.1, 0.3, 0.5), fruit = sprintf("f%02d", 1:12))
pilot$k <- signif(1 - 0.3 * pilot$V + rnorm(12, 0, 0.15)[as.integer(pilot$fruit)] + rnorm(36, 0, 0.1), 6)
path <- write_table("pilot", pilot)
fit <- lmerTest::lmer(k ~ V + (1 | fruit), pilot)
drawn <- simulate(fit, 300, seed = 3)
found <- vapply(drawn, function(y) {
  own <- suppressMessages(lmerTest::lmer(y ~ V + (1 | fruit), cbind(pilot, y = y)))
  coef(summary(own))["V", "Pr(>|t|)"] < 0.05
}, TRUE)
rows <- ask_plan("model", shQuote(path), "--formula", shQuote("k ~ V + (1 | fruit)"), "--fruit 12 --simulations 4000")
lme4_error <- sqrt(mean(found) * (1 - mean(found)) / 300)
cat(sprintf("power of V by simulation: lme4 and lmerTest %.3f (error %.3f), windfall %.3f (error %.3f)\n", mean(found), lme4_error, rows$power$value, rows$power$se))
compare("plan", "simulated, difference in errors", abs(rows$power$value - mean(found)) / sqrt(lme4_error^2 + rows$power$se^2) + 1, 1, 4)
