# Generates the tables and reference numbers for the tests of mixed models:
#
#   Rscript bench/mixed_reference.R
#
# Data come from a fixed generator (below), are written with six decimals and read
# back, so that R and windfall see the same numbers. lme4's estimate is polished
# until the gradient of its deviance vanishes; its default stops near 1e-6.
suppressMessages({
  library(lme4)
  library(lmerTest)
  library(pbkrtest)
  library(jsonlite)
})
folder <- "crates/mixed/tests/data"

# Park and Miller's generator, exact in double precision
state <- 20131105
uniform <- function(n) {
  out <- numeric(n)
  for (i in seq_len(n)) {
    state <<- (16807 * state) %% 2147483647
    out[i] <- state / 2147483647
  }
  out
}
normal <- function(n) qnorm(uniform(n))

write_table <- function(name, table) {
  path <- file.path(folder, paste0(name, ".csv"))
  numbers <- sapply(table, is.double)
  table[numbers] <- lapply(table[numbers], function(x) sprintf("%.6f", x))
  write.csv(table, path, row.names = FALSE, quote = FALSE)
  read.csv(path, stringsAsFactors = FALSE)
}

# --- tables ---------------------------------------------------------------
growth <- {
  t <- expand.grid(day = 0:9, subject = 1:18)
  a <- 250 + 25 * normal(18)
  b <- 10 + 6 * normal(18)
  t$day <- as.double(t$day)
  t$y <- a[t$subject] + b[t$subject] * t$day + 25 * normal(nrow(t))
  t$subject <- sprintf("s%02d", t$subject)
  write_table("growth", t)
}
# the apple study's design: 20 fruit at four velocities, 10 at a fifth, 10 at a sixth
apple <- {
  t <- rbind(
    expand.grid(velocity = c(0.1, 0.2, 0.27, 0.34), fruit = 1:20),
    expand.grid(velocity = 0.5, fruit = 21:30),
    expand.grid(velocity = 0.7, fruit = 31:40)
  )
  radius <- 35 + 4 * uniform(40)
  own <- 60 * normal(40)
  t$radius <- radius[t$fruit]
  t$k <- 900 - 350 * t$velocity + 8 * (t$radius - 37) + own[t$fruit] + 35 * normal(nrow(t))
  t$fruit <- sprintf("f%02d", t$fruit)
  write_table("apple", t)
}
crossed <- {
  t <- expand.grid(repeats = 1:2, fruit = 1:12, operator = 1:10)
  o <- 2 * normal(10)
  f <- 5 * normal(12)
  t$level <- round(uniform(nrow(t)), 3)
  t$y <- 40 + 6 * t$level + o[t$operator] + f[t$fruit] + 1.5 * normal(nrow(t))
  t <- t[uniform(nrow(t)) > 0.1, ]
  t$fruit <- sprintf("f%02d", t$fruit)
  t$operator <- sprintf("o%02d", t$operator)
  t$repeats <- NULL
  write_table("crossed", t)
}
nested <- {
  t <- expand.grid(impact = 1:3, fruit = 1:6, variety = 1:8)
  v <- 8 * normal(8)
  f <- matrix(5 * normal(48), 8)
  t$side <- ifelse(t$impact == 1, "sun", ifelse(t$impact == 2, "shade", "stem"))
  t$y <- 70 + v[t$variety] + f[cbind(t$variety, t$fruit)] + 2 * (t$side == "sun") + 3 * normal(nrow(t))
  t <- t[uniform(nrow(t)) > 0.15, ]
  t$variety <- sprintf("v%d", t$variety)
  t$fruit <- sprintf("f%d", t$fruit)
  t$impact <- NULL
  write_table("nested", t)
}
# no variation between groups beyond chance
level <- {
  t <- expand.grid(row = 1:6, group = 1:8)
  t$x <- round(uniform(nrow(t)), 3)
  e <- normal(nrow(t))
  t$y <- 5 + t$x + e - ave(e, t$group) * 0.9
  t$group <- sprintf("g%d", t$group)
  t$row <- NULL
  write_table("level", t)
}
# slopes that follow the intercepts exactly
linked <- {
  t <- expand.grid(row = 1:8, group = 1:9)
  t$x <- round(2 * uniform(nrow(t)), 3)
  u <- normal(9)
  t$y <- 5 + t$x + u[t$group] * (1 + 0.5 * t$x) + 0.8 * normal(nrow(t))
  t$group <- sprintf("g%d", t$group)
  t$row <- NULL
  write_table("linked", t)
}
# balanced split plot: orchards as blocks, storage on whole plots, drop height within
split <- {
  t <- expand.grid(height = c("low", "middle", "high"), storage = c("cold", "warm"), orchard = 1:6)
  o <- 12 * normal(6)
  w <- matrix(5 * normal(12), 6)
  t$y <- 50 + o[t$orchard] + w[cbind(t$orchard, as.integer(t$storage))] +
    5 * (t$height == "high") - 2 * (t$storage == "warm") + 2 * normal(nrow(t))
  t$orchard <- sprintf("o%d", t$orchard)
  t$storage <- as.character(t$storage)
  t$height <- as.character(t$height)
  write_table("split", t)
}

# --- fits -----------------------------------------------------------------
polished <- function(formula, data, reml) {
  parsed <- lFormula(formula, data, REML = reml)
  deviance <- do.call(mkLmerDevfun, parsed)
  theta <- parsed$reTrms$theta
  lower <- parsed$reTrms$lower
  for (round in 1:4) {
    found <- minqa::bobyqa(theta, deviance, lower = lower,
      control = list(rhobeg = if (round == 1) 0.2 else 1e-3, rhoend = 1e-10, maxfun = 20000))
    theta <- found$par
  }
  theta[lower == 0 & theta < 1e-6] <- 0
  free <- which(!(lower == 0 & theta == 0))
  for (round in 1:4) {
    if (length(free) == 0) break
    part <- function(x) { at <- theta; at[free] <- x; deviance(at) }
    g <- numDeriv::grad(part, theta[free])
    h <- numDeriv::hessian(part, theta[free])
    if (rcond(h) < 1e-10) break
    moved <- theta
    moved[free] <- theta[free] - solve(h, g)
    if (deviance(moved) <= deviance(theta) + 1e-9) theta <- moved
  }
  deviance(theta)
  list(model = mkMerMod(environment(deviance), list(par = theta, fval = deviance(theta),
    conv = 0, message = NULL), parsed$reTrms, fr = parsed$fr), theta = theta)
}

# R² of Nakagawa and Schielzeth, with slopes as in Johnson
shares <- function(model) {
  fixed <- var(drop(model.matrix(model) %*% fixef(model)))
  lambda <- getME(model, "Lambda")
  z <- getME(model, "Z")
  random <- sum((z %*% lambda)^2) * sigma(model)^2 / nrow(z)
  c(fixed, fixed + random) / (fixed + random + sigma(model)^2)
}
strict <- lmerControl(optimizer = "bobyqa", optCtrl = list(rhoend = 1e-9, maxfun = 1e5))
one <- function(table, formula, reml = TRUE, profile = FALSE, kr = FALSE, f = NULL) {
  data <- get(table)
  formula <- as.formula(formula)
  fit <- lmer(formula, data, REML = reml)
  p <- polished(formula, data, reml)
  model <- p$model
  model@call <- fit@call
  deviance <- update(as(fit, "lmerMod"), devFunOnly = TRUE)
  deviance(p$theta)
  test <- lmerTest:::as_lmerModLT(model, deviance)
  coefficients <- coef(summary(test))
  variances <- as.data.frame(VarCorr(model))
  effects <- ranef(model, condVar = TRUE)
  out <- list(
    table = table,
    formula = deparse1(formula),
    method = if (reml) "reml" else "ml",
    names = rownames(coefficients),
    coefficients = unname(fixef(model)),
    covariance = unname(as.matrix(vcov(model))),
    se = unname(coefficients[, "Std. Error"]),
    df = unname(coefficients[, "df"]),
    t = unname(coefficients[, "t value"]),
    p = unname(coefficients[, "Pr(>|t|)"]),
    theta = p$theta,
    sigma = sigma(model),
    sdcor = variances$sdcor,
    log_likelihood = as.numeric(logLik(model)),
    aic = AIC(model),
    bic = BIC(model),
    effects = lapply(effects, function(e) as.matrix(e) |> unname()),
    effect_names = lapply(effects, rownames),
    effect_sds = lapply(effects, function(e) {
      v <- attr(e, "postVar")
      if (is.list(v)) unname(sapply(v, function(x) sqrt(x[1, 1, ])))
      else t(matrix(apply(v, 3, function(x) sqrt(diag(as.matrix(x)))), nrow = dim(v)[1]))
    }),
    r2 = shares(model),
    fitted_first = unname(fitted(model)[1:5])
  )
  out$default_df <- unname(coef(summary(fit))[, "df"])
  if (!is.null(f)) {
    table3 <- anova(test, type = 3)
    out$f_tests <- lapply(rownames(table3), function(term) list(term = term,
      f = table3[term, "F value"], numerator = table3[term, "NumDF"],
      denominator = table3[term, "DenDF"], p = table3[term, "Pr(>F)"]))
  }
  if (kr) {
    adjusted <- vcovAdj(as(model, "lmerMod"))
    out$kr_covariance <- unname(as.matrix(adjusted))
    out$kr_df <- sapply(seq_along(fixef(model)), function(i) {
      l <- rep(0, length(fixef(model)))
      l[i] <- 1
      Lb_ddf(l, vcov(model), adjusted)
    })
    out$kr_f <- lapply(f, function(columns) {
      l <- diag(length(fixef(model)))[columns, , drop = FALSE]
      r <- KRmodcomp(as(model, "lmerMod"), l)
      s <- r$stats
      list(columns = columns, f = s$Fstat, numerator = s$ndf, denominator = s$ddf,
        scaling = s$F.scaling, p = s$p.value)
    })
  }
  if (profile) {
    interval <- confint(profile(lme4::lmer(formula, data, REML = FALSE, control = strict), which = "theta_", delta = 0.1), level = 0.95)
    out$profile <- unname(interval)
    out$profile_names <- rownames(interval)
  }
  out
}

contrasts_used <- options(contrasts = c("contr.sum", "contr.poly"))
cases <- list(
  one("growth", "y ~ day + (1 + day | subject)", profile = TRUE, kr = TRUE, f = list(2)),
  one("growth", "y ~ day + (1 + day | subject)", reml = FALSE),
  one("growth", "y ~ day + (1 + day || subject)", profile = TRUE, kr = TRUE, f = list(2)),
  one("apple", "k ~ velocity + radius + (1 | fruit)", profile = TRUE, kr = TRUE, f = list(2, 3, 2:3)),
  one("apple", "k ~ velocity + radius + (1 | fruit)", reml = FALSE),
  one("apple", "k ~ velocity + (1 | fruit)", reml = FALSE),
  one("crossed", "y ~ level + (1 | operator) + (1 | fruit)", profile = TRUE, kr = TRUE, f = list(2)),
  one("crossed", "y ~ level + (1 + level | operator) + (1 | fruit)", kr = TRUE, f = list(2)),
  one("nested", "y ~ side + (1 | variety / fruit)", profile = TRUE, kr = TRUE, f = list(2:3)),
  one("level", "y ~ x + (1 | group)"),
  one("linked", "y ~ x + (1 + x | group)"),
  one("split", "y ~ storage * height + (1 | orchard) + (1 | orchard:storage)", kr = TRUE,
    f = list(2, 3:4, 5:6))
)
options(contrasts_used)
comparison <- {
  big <- lmer(k ~ velocity + radius + (1 | fruit), apple, REML = FALSE)
  small <- lmer(k ~ velocity + (1 | fruit), apple, REML = FALSE)
  a <- anova(small, big)
  list(chi_square = a[2, "Chisq"], df = a[2, "Df"], p = a[2, "Pr(>Chisq)"])
}
versions <- sapply(c("lme4", "lmerTest", "pbkrtest"), function(p) as.character(packageVersion(p)))
write(toJSON(list(versions = as.list(versions), cases = cases, comparison = comparison),
  digits = NA, auto_unbox = TRUE), file.path(folder, "reference.json"))
