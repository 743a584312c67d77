# Regressions are those of lm, to 1e-9.
library(windfall)

# Every estimate, standard error and covariance; in the order of the terms of lm.
check <- function(formula, frame) {
  ours <- wf_regress(frame, formula)
  theirs <- lm(formula, frame)
  table <- summary(theirs)$coefficients
  near <- function(a, b) max(abs(a - b) / max(abs(b))) < 1e-9
  stopifnot(
    length(coef(ours)) == nrow(table),
    near(coef(ours), table[, 1]),
    near(ours$terms$se, table[, 2]),
    near(ours$terms$t, table[, 3]),
    near(vcov(ours), vcov(theirs)),
    near(ours$sigma, sigma(theirs)),
    near(ours$influence$fitted, fitted(theirs)),
    ours$rows == nobs(theirs)
  )
}

set.seed(7)
n <- 60
frame <- data.frame(
  v = runif(n, 0.2, 0.6), r = runif(n, 0.03, 0.05),
  fruit = sample(c("apple", "\u00c4pfel, rote", "pear"), n, TRUE),
  dose = factor(sample(c("low", "medium", "high"), n, TRUE), levels = c("low", "medium", "high")),
  ripe = sample(c(TRUE, FALSE), n, TRUE), day = sample(1:4, n, TRUE)
)
frame[["gr\u00f6\u00dfe in mm"]] <- rnorm(n, 70, 5)
frame$k <- exp(13 + frame$v - 20 * frame$r + 0.3 * (frame$fruit == "pear") + rnorm(n, 0, 0.1))
frame$v[3] <- NA
frame$k[5] <- NA

check(k ~ v + r, frame)
check(log(k) ~ v * dose, frame)
check(log(k) ~ (v + r + ripe)^2, frame)
check(log(k) ~ fruit + ripe + factor(day), frame)
size <- as.name("gr\u00f6\u00dfe in mm")
check(eval(bquote(log(k) ~ v + I(v^2) + .(size))), frame)
check(log(k) ~ 0 + dose + sqrt(v), frame)
check(k ~ ., frame)
# lm makes polynomials of rows that it leaves out, too.
check(log(k) ~ poly(r, 2) + v:r, na.omit(frame))
# In R v^2 is v crossed with itself, which is v.
check(log(k) ~ v^2, frame)

# Random effects in the words of lme4: a balanced design, whose estimates are known
# in closed form from the analysis of variance.
balanced <- data.frame(fruit = rep(letters[1:8], each = 4), x = rep(0:1, 16))
balanced$y <- 3 + rep(rnorm(8), each = 4) + balanced$x + rnorm(32, 0, 0.3)
mixed <- wf_regress(balanced, y ~ x + (1 | fruit))
parts <- anova(lm(y ~ x + fruit, balanced))["Mean Sq"][[1]]
slope <- with(balanced, mean(y[x == 1]) - mean(y[x == 0]))
stopifnot(
  abs(coef(mixed)[["x"]] - slope) < 1e-9,
  # The slope is seen within fruit: its variance is that of the residuals alone.
  abs(mixed$terms$se[[2]] - sqrt(parts[[3]] * 4 / 32)) < 1e-6
)

# What cannot be meant is refused.
refused <- function(formula) tryCatch(wf_regress(frame, formula), error = conditionMessage)
stopifnot(
  grepl("no offset", refused(k ~ v + offset(r))),
  grepl("with a response", refused(~v)),
  grepl("no function \"tan\"", refused(k ~ tan(v)))
)

# Options go to the command.
weighted <- wf_regress(cbind(frame, n = rep(1:3, 20)), k ~ v, weights = "n", confidence = 0.9)
theirs <- lm(k ~ v, frame, weights = rep(1:3, 20))
limits <- confint(theirs, level = 0.9)
stopifnot(max(abs(weighted$terms$low / limits[, 1] - 1)) < 1e-9)

shown <- capture.output(print(weighted))
stopifnot(any(grepl("R-squared", shown)), any(grepl("(Intercept)", shown, fixed = TRUE)))
