# Weights of rows against lm, lmer, emmeans, sandwich and car.
# Part of compare_statistics.R.

suppressMessages({ library(nlme); library(sandwich); library(lmtest) })

formula_text <- function(formula) shQuote(paste(deparse(formula, width.cutoff = 500), collapse = ""))

# Everything that follows from a fit with weights; `weights` names a column.
check_weighed <- function(group, table, formula, weights, means = NULL) {
  path <- write_table(group, table)
  text <- formula_text(formula)
  own_weights <- table[[weights]]
  weigh <- paste("--weights", shQuote(weights))
  table$.weights <- own_weights
  fit <- do.call(lm, list(formula, table, weights = own_weights))
  own <- summary(fit)
  found <- ask(path, "--formula", text, weigh, "--folds 0")
  limit <- 1e-8
  kept <- !is.na(coef(fit))
  compare(group, "estimate", found$terms$estimate, unname(coef(fit)[kept]), limit)
  compare(group, "standard error", found$terms$se, unname(own$coefficients[, 2]), limit)
  compare(group, "p", found$terms$p, unname(own$coefficients[, 4]), limit)
  compare(group, "interval", c(found$terms$low, found$terms$high), unname(c(confint(fit)[kept, ])), limit)
  compare(group, "sigma, R2, adjusted", c(found$sigma, found$r2, found$r2_adjusted), c(own$sigma, own$r.squared, own$adj.r.squared), limit)
  w <- weights(fit)
  h <- hatvalues(fit)
  e <- weighted.residuals(fit)
  mean_y <- weighted.mean(model.response(model.frame(fit)), w)
  press <- sum((e / (1 - h))^2)
  total <- if (attr(terms(fit), "intercept") == 1) sum(w * (model.response(model.frame(fit)) - mean_y)^2) else sum(w * model.response(model.frame(fit))^2)
  compare(group, "PRESS and R2 of it", c(found$press, found$r2_predicted), c(press, 1 - press / total), limit)
  compare(group, "AIC, BIC, log-likelihood", c(found$aic, found$bic, found$log_likelihood), c(AIC(fit), BIC(fit), as.numeric(logLik(fit))), limit)
  compare(group, "residual", found$influence$residual, unname(resid(fit)), 1e-6)
  compare(group, "leverage", found$influence$leverage, unname(h), limit)
  compare(group, "standardised residual", found$influence$standardised, unname(rstandard(fit)), limit)
  compare(group, "studentised residual", found$influence$studentised, unname(rstudent(fit)), limit)
  compare(group, "Cook, DFFITS", c(found$influence$cook, found$influence$dffits), unname(c(cooks.distance(fit), dffits(fit))), limit)
  if (length(found$vif) > 0) {
    factors <- vif(fit)
    compare(group, "VIF", found$vif$factor, unname(if (is.matrix(factors)) factors[, 1] else factors), limit)
  }
  robust <- ask(path, "--formula", text, weigh, "--folds 0 --robust")
  compare(group, "HC3", robust$terms$se, unname(sqrt(diag(vcovHC(fit, "HC3")))), limit)
  # Tests of residuals: of a model of rows times the roots of their weights.
  x <- model.matrix(fit)[, kept, drop = FALSE]
  tests <- found$residuals$tests
  value <- function(name) tests[grep(name, tests$test), c("statistic", "p")]
  if (length(tests) > 0) {
    normal <- shapiro.test(e)
    compare(group, "Shapiro-Wilk", unlist(value("Shapiro")), c(normal$statistic, normal$p.value), 1e-6)
    auxiliary <- summary(lm(e^2 ~ x))
    if (ncol(x) > 1) compare(group, "Breusch-Pagan", value("Breusch")$statistic, length(e) * auxiliary$r.squared, limit)
    if (length(e) - ncol(x) > 2) compare(group, "Durbin-Watson", value("Durbin")$statistic, sum(diff(e)^2) / sum(e^2), limit)
  }
  for (type in 1:3) {
    expected <- if (type == 1) anova(fit) else if (type == 2) Anova(fit, type = 2) else {
      old <- options(contrasts = c("contr.sum", "contr.poly"))
      result <- Anova(do.call(lm, list(formula, table, weights = own_weights)), type = 3)
      options(old)
      if (attr(terms(fit), "intercept") == 1) result[-1, ] else result
    }
    answer <- ask(path, "--formula", text, weigh, "--folds 0", paste("--anova", type))
    rows <- seq_len(nrow(expected) - 1)
    compare(group, paste("ANOVA", type, "SS"), c(answer$anova$ss, answer$residual$ss), expected[["Sum Sq"]], limit)
    compare(group, paste("ANOVA", type, "F"), answer$anova$f, expected[["F value"]][rows], limit)
    compare(group, paste("ANOVA", type, "p"), answer$anova$p, expected[["Pr(>F)"]][rows], limit)
  }
  # A further observation has weight 1.
  new <- table[seq_len(5), setdiff(names(table), ".weights"), drop = FALSE]
  path_new <- write_table(paste0(group, " new"), new)
  answer <- ask(path, "--formula", text, weigh, "--folds 0 --predict", shQuote(path_new))
  mean_interval <- predict(fit, new, interval = "confidence")
  interval <- suppressWarnings(predict(fit, new, interval = "prediction", weights = 1))
  compare(group, "prediction", c(answer$predictions$predicted, answer$predictions$mean_low, answer$predictions$high), unname(c(mean_interval[, 1], mean_interval[, 2], interval[, 3])), limit)
  # Rows left out one at a time.
  rows <- nrow(model.matrix(fit))
  answer <- ask(path, "--formula", text, weigh, paste("--folds", rows))
  if (!is.null(answer$cross_validation)) compare(group, "cross-validation", answer$cross_validation$rms, sqrt(press / sum(w)), limit)
  if (!is.null(means)) {
    answer <- ask(path, "--formula", text, weigh, "--folds 0 --means", means)$means
    grid <- emmeans(fit, means)
    theirs <- as.data.frame(grid)
    order <- match(unlist(answer$means[[1]]$levels), as.character(theirs[[means]]))
    compare(group, "means", c(answer$means[[1]]$mean, answer$means[[1]]$se), c(theirs$emmean[order], theirs$SE[order]), limit)
    pairs <- as.data.frame(contrast(grid, "revpairwise"))
    compare(group, "differences", sort(abs(answer$differences[[1]]$t)), sort(abs(pairs$t.ratio)), limit)
  }
}

set.seed(28)
dents <- data.frame(variety = rep(c("Gala", "Fuji", "Golden"), c(14, 9, 7)), V = round(runif(30, 0.1, 0.8), 3), n = sample(1:12, 30, TRUE))
dents$depth <- signif(2 + 5 * dents$V + 0.4 * as.integer(factor(dents$variety)) + rnorm(30, 0, 0.6) / sqrt(dents$n), 5)
dents$ripe <- sample(c("no", "yes"), 30, TRUE)
check_weighed("weighed dents", dents, depth ~ V * variety, "n", "variety")
check_weighed("weighed dents log", dents, log(depth) ~ poly(V, 2) + variety + ripe, "n", "variety")
check_weighed("weighed dents without intercept", dents, depth ~ 0 + variety + V, "n")
# Rows without a weight are left out by both.
gap <- dents
gap$n[c(3, 8, 20)] <- NA
check_weighed("weighed dents, weights missing", gap, depth ~ V + variety, "n", "variety")
wide <- dents
wide$w <- 10^runif(30, -4, 4)
check_weighed("weights of eight decades", wide, depth ~ V + variety, "w", "variety")
# Data of other people.
cars <- mtcars
cars$cyl <- paste0("c", cars$cyl)
check_weighed("mtcars", cars, mpg ~ wt + cyl + hp, "qsec", "cyl")
check_weighed("mtcars with interaction", cars, mpg ~ wt * cyl + I(hp^2), "disp", NULL)
insurance <- transform(as.data.frame(MASS::Insurance), District = paste0("d", District), Group = paste0("g", as.integer(Group)), Age = paste0("a", as.integer(Age)), rate = Claims / Holders)
check_weighed("Insurance", insurance, rate ~ District + Group + Age, "Holders", "Group")
warp <- transform(aggregate(breaks ~ wool + tension, warpbreaks, mean), n = c(3, 9, 5, 9, 7, 2), wool = as.character(wool), tension = as.character(tension))
check_weighed("warpbreaks of means", warp, breaks ~ wool + tension, "n", "tension")
prestige <- transform(na.omit(carData::Prestige), type = as.character(type))
prestige$women <- prestige$women + 1
check_weighed("Prestige", prestige, prestige ~ education + log(income) * type, "women", NULL)
growth <- transform(ToothGrowth, supp = as.character(supp), dose = paste0("d", dose), n = rep(c(1, 4, 2), 20))
check_weighed("ToothGrowth", growth, len ~ supp * dose, "n", "dose")
stack <- transform(stackloss, w = 22 - seq_len(21))
check_weighed("stackloss", stack, stack.loss ~ Air.Flow + Water.Temp + Acid.Conc., "w")
air <- transform(airquality, Month = paste0("m", Month))
check_weighed("airquality", air, sqrt(Ozone) ~ Temp + Wind + Month, "Wind", "Month")
economy <- transform(longley, w = rev(Year - 1946))
check_weighed("longley", economy, Employed ~ GNP + Unemployed + Armed.Forces, "w")

check_weighed_mixed <- function(group, table, formula, weights, maximum = FALSE, means = NULL) {
  path <- write_table(group, table)
  table$.weights <- table[[weights]]
  control <- lmerControl(optimizer = "bobyqa", optCtrl = list(rhobeg = 0.2, rhoend = 1e-10, maxfun = 1e5), calc.derivs = FALSE)
  fit <- suppressWarnings(do.call(lmerTest::lmer, list(formula, table, weights = table$.weights, REML = !maximum, control = control)))
  likelihood <- paste("--likelihood", if (maximum) "ml" else "reml", "--weights", weights)
  found <- ask(path, "--formula", formula_text(formula), likelihood)
  own <- coef(summary(fit))
  limit <- 1e-5
  compare(group, "estimate", found$terms$estimate, unname(own[, "Estimate"]), limit)
  compare(group, "standard error", found$terms$se, unname(own[, "Std. Error"]), limit)
  compare(group, "Satterthwaite df", found$terms$df, unname(own[, "df"]), limit)
  compare(group, "criterion", c(found$criterion, found$aic, found$bic), c(-2 * as.numeric(logLik(fit)), AIC(fit), BIC(fit)), limit)
  variances <- as.data.frame(VarCorr(fit))
  compare(group, "standard deviations", found$variances$value[found$variances$kind == "sd"], variances$sdcor[is.na(variances$var2)], limit)
  tests <- anova(fit, type = 3)
  compare(group, "F", found$anova$f, tests[["F value"]], limit)
  compare(group, "effects of groups", sort(found$effects$value), sort(as.data.frame(ranef(fit))$condval), 1e-4)
  if (maximum) {
    profile <- suppressMessages(suppressWarnings(confint(fit, method = "profile", oldNames = FALSE, parm = "theta_", devtol = 1e-9)))
    order <- c(grep("^sd", rownames(profile)), grep("^sigma", rownames(profile)))
    sds <- found$variances[found$variances$kind == "sd", ]
    compare(group, "profile intervals", c(sds$low, sds$high), unname(c(profile[order, ])), 1e-3)
  }
  if (!is.null(means)) {
    answer <- ask(path, "--formula", formula_text(formula), likelihood, "--means", means)$means$means[[1]]
    theirs <- as.data.frame(emmeans(fit, means, lmer.df = "satterthwaite"))
    order <- match(unlist(answer$levels), as.character(theirs[[means]]))
    compare(group, "means", c(answer$mean, answer$se, answer$df), c(theirs$emmean[order], theirs$SE[order], theirs$df[order]), limit)
  }
}
weighed_days <- transform(days, n = 1 + (as.integer(subject) * 7 + day * 3) %% 5, subject = as.character(subject))
check_weighed_mixed("weighed days", weighed_days, y ~ day + (1 + day | subject), "n")
check_weighed_mixed("weighed days by ML", weighed_days, y ~ day + (1 | subject), "n", TRUE)
weighed_impacts <- transform(impacts, n = 1 + (seq_len(nrow(impacts)) * 5) %% 7)
check_weighed_mixed("weighed impacts", weighed_impacts, k ~ V * variety + R + (1 | specimen), "n", means = "variety")
# Herds of cattle: the part that falls ill, of herds of different size.
herds <- transform(as.data.frame(lme4::cbpp), rate = incidence / size, herd = paste0("h", herd), period = paste0("p", period))
check_weighed_mixed("cbpp", herds, rate ~ period + (1 | herd), "size", means = "period")
# Rails, machines: means of as many measurements as there are.
machines <- transform(aggregate(score ~ Worker + Machine, as.data.frame(nlme::Machines), mean), n = c(3, 1, 2, 3, 3, 1, 2, 3, 1), Worker = paste0("w", Worker), Machine = as.character(Machine))
check_weighed_mixed("Machines", machines, score ~ Machine + (1 | Worker), "n", means = "Machine")
