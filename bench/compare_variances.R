# Weights of rows against lm, lmer, emmeans, sandwich and car.
# Part of compare_statistics.R.

suppressMessages({ library(nlme); library(sandwich) })

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

# Residual variances by level: gls with varIdent. Its degrees of freedom are emmeans', which takes
# derivatives by rough differences; they are also found here from the likelihood itself.
level_variances <- function(fit, table, by) {
  structure <- fit$modelStruct$varStruct
  parts <- coef(structure, unconstrained = FALSE, allCoef = TRUE)
  (fit$sigma * parts)^2
}

# Second derivative of the likelihood, and first of the covariance of the estimates, by the
# logarithms of the variances: by Richardson's differences of what is written out here.
uncertainty_of <- function(x, y, level, variances, restricted) {
  groups <- names(variances)
  likelihood <- function(logs) {
    v <- exp(logs)[match(level, groups)]
    fit <- lm.wfit(x, y, 1 / v)
    fixed <- if (restricted) 2 * sum(log(abs(diag(qr.R(fit$qr))))) else 0
    -0.5 * (sum(log(v)) + fixed + sum(fit$residuals^2 / v))
  }
  covariance <- function(logs) c(solve(crossprod(x / sqrt(exp(logs)[match(level, groups)]))))
  logs <- log(variances)
  slopes <- numDeriv::jacobian(covariance, logs)
  size <- rep(ncol(x), 2)
  list(
    covariance = solve(-numDeriv::hessian(likelihood, logs)),
    slopes = lapply(seq_along(groups), function(own) array(slopes[, own], size)), c = array(covariance(logs), size)
  )
}

check_levels <- function(group, table, formula, by, maximum = FALSE, means = NULL) {
  path <- write_table(group, table)
  text <- formula_text(formula)
  # emmeans takes rows with missing cells along otherwise.
  table <- table[complete.cases(table[all.vars(formula)]), ]
  table$.by <- table[[by]]
  # nlme stops at a step of 1e-6: its fit is carried on from there.
  control <- glsControl(tolerance = 1e-14, msTol = 1e-14, opt = "nlminb", maxIter = 500, msMaxIter = 500)
  method <- if (maximum) "ML" else "REML"
  fit <- do.call(gls, list(formula, table, weights = varIdent(form = ~ 1 | .by), method = method, control = control, na.action = na.omit))
  asked <- paste("--variance", by, "--likelihood", tolower(method))
  found <- ask(path, "--formula", text, asked)
  limit <- 1e-5
  own <- summary(fit)$tTable
  compare(group, "estimate", found$terms$estimate, unname(own[, 1]), limit)
  compare(group, "standard error", found$terms$se, unname(own[, 2]), limit)
  compare(group, "log-likelihood, AIC", c(found$log_likelihood, found$aic), c(as.numeric(logLik(fit)), AIC(fit)), 1e-8)
  variances <- level_variances(fit, table, by)
  levels <- found$level_variances$levels
  order <- match(levels$level, names(variances))
  stopifnot(!anyNA(order))
  compare(group, "standard deviations", levels$sd, unname(sqrt(variances[order])), limit)
  one <- do.call(gls, list(formula, table, method = method, na.action = na.omit))
  compare(group, "likelihood ratio", found$level_variances$test$statistic, 2 * as.numeric(logLik(fit) - logLik(one)), 1e-6)
  compare(group, "p of it", found$level_variances$test$p, anova(fit, one)[["p-value"]][2], 1e-6)
  frame <- model.frame(update(formula, . ~ . + .by), table)
  x <- model.matrix(formula, frame)
  windfall_variances <- setNames(levels$sd^2, levels$level)
  exact <- uncertainty_of(x, model.response(frame), as.character(frame$.by), windfall_variances, !maximum)
  df <- function(weights) {
    slope <- vapply(exact$slopes, function(own) drop(weights %*% own %*% weights), 0)
    2 * drop(weights %*% exact$c %*% weights)^2 / drop(slope %*% exact$covariance %*% slope)
  }
  compare(group, "degrees of freedom", found$terms$df, apply(diag(ncol(x)), 1, df), 1e-6)
  compare(group, "freedom of variances", levels$df, 2 / unname(diag(exact$covariance)), 1e-6)
  marginal <- ask(path, "--formula", text, asked, "--anova 3")
  old <- options(contrasts = c("contr.sum", "contr.poly"))
  summed <- do.call(gls, list(formula, table, weights = varIdent(form = ~ 1 | .by), method = method, control = control, na.action = na.omit))
  theirs <- anova(summed, type = "marginal")
  options(old)
  compare(group, "F of type III", marginal$anova$f, theirs[setdiff(rownames(theirs), "(Intercept)"), "F-value"], limit)
  sequential <- ask(path, "--formula", text, asked, "--anova 1")
  theirs <- anova(fit, type = "sequential")
  compare(group, "F of type I", sequential$anova$f, theirs[setdiff(rownames(theirs), "(Intercept)"), "F-value"], limit)
  if (!is.null(means)) {
    answer <- ask(path, "--formula", text, asked, "--means", means)$means
    grid <- emmeans(fit, means, data = table, mode = "satterthwaite")
    theirs <- as.data.frame(grid)
    order <- match(unlist(answer$means[[1]]$levels), as.character(theirs[[means]]))
    compare(group, "means", c(answer$means[[1]]$mean, answer$means[[1]]$se), c(theirs$emmean[order], theirs$SE[order]), limit)
    # Of fits by maximum likelihood emmeans' depend on which level is the reference.
    if (!maximum) compare(group, "degrees of freedom of means in emmeans", answer$means[[1]]$df, theirs$df[order], 2e-2)
    pairs <- as.data.frame(contrast(grid, "revpairwise"))
    compare(group, "differences", sort(abs(answer$differences[[1]]$t)), sort(abs(pairs$t.ratio)), limit)
  }
}

uneven <- data.frame(g = rep(c("a", "b", "c"), c(6, 11, 8)), V = round(runif(25), 3))
uneven$y <- signif(3 + uneven$V + c(0, 1, 2)[factor(uneven$g)] + rnorm(25, 0, c(0.5, 2, 1)[factor(uneven$g)]), 6)
check_levels("levels: one-way", uneven, y ~ g, "g", means = "g")
check_levels("levels: covariate", uneven, y ~ g + V, "g", means = "g")
check_levels("levels: interaction by ML", uneven, y ~ g * V, "g", TRUE, "g")
uneven$y[c(4, 15)] <- NA
uneven$h <- rep(c("u", "v"), length.out = 25)
check_levels("levels: of another category, missing cells", uneven, log(y^2) ~ g + h, "h", means = "g")
# Data of other people.
teeth <- transform(as.data.frame(nlme::Orthodont), Sex = as.character(Sex))[c("distance", "age", "Sex")]
check_levels("levels: Orthodont", teeth, distance ~ age * Sex, "Sex", means = "Sex")
feed <- transform(chickwts, feed = as.character(feed))
check_levels("levels: chickwts", feed, weight ~ feed, "feed", means = "feed")
sprays <- transform(InsectSprays, spray = as.character(spray))[-c(3, 4, 40, 41, 42), ]
check_levels("levels: InsectSprays", sprays, count ~ spray, "spray", means = "spray")
flowers <- transform(iris, Species = as.character(Species))[-(1:17), ]
names(flowers) <- gsub(".", "_", names(flowers), fixed = TRUE)
check_levels("levels: iris", flowers, Sepal_Length ~ Petal_Length + Species, "Species", means = "Species")
check_levels("levels: iris by ML", flowers, Sepal_Length ~ Petal_Length * Species, "Species", TRUE)
check_levels("levels: ToothGrowth", growth[-c(1, 2, 33), ], len ~ supp * dose, "dose", means = "supp")
months <- transform(airquality, Month = paste0("m", Month))
check_levels("levels: airquality", months, Ozone ~ Temp + Wind + Month, "Month")
jobs <- transform(na.omit(carData::Prestige), type = as.character(type))
check_levels("levels: Prestige", jobs, prestige ~ education + log(income) + type, "type", means = "type")

# The same beside random effects: lme with varIdent.
check_mixed_levels <- function(group, table, fixed, random, text, by, maximum = FALSE, means = NULL) {
  path <- write_table(group, table)
  table$.by <- table[[by]]
  method <- if (maximum) "ML" else "REML"
  control <- lmeControl(tolerance = 1e-10, msTol = 1e-13, opt = "nlminb", maxIter = 500, msMaxIter = 1000, msMaxEval = 5000)
  fit_of <- function(...) do.call(lme, list(fixed, data = table, random = random, method = method, control = control, ...))
  fit <- fit_of(weights = varIdent(form = ~ 1 | .by))
  asked <- paste("--variance", by, "--likelihood", tolower(method))
  found <- ask(path, "--formula", shQuote(text), asked)
  limit <- 1e-5
  own <- summary(fit)$tTable
  compare(group, "estimate", found$terms$estimate, unname(own[, "Value"]), limit)
  # lme's errors by ML are of the residual variance of REML.
  if (!maximum) compare(group, "standard error", found$terms$se, unname(own[, "Std.Error"]), limit)
  compare(group, "log-likelihood, AIC", c(found$log_likelihood, found$aic), c(as.numeric(logLik(fit)), AIC(fit)), 1e-8)
  variances <- level_variances(fit, table, by)
  residual <- found$variances[found$variances$group == "residual", ]
  order <- match(residual$of, names(variances))
  stopifnot(!anyNA(order))
  compare(group, "residual standard deviations", residual$value, unname(sqrt(variances[order])), limit)
  between <- found$variances[found$variances$group != "residual" & found$variances$kind == "sd", ]
  theirs <- unlist(lapply(fit$modelStruct$reStruct, function(own) sqrt(diag(as.matrix(own)))))
  compare(group, "standard deviations between groups", sort(between$value), sort(unname(theirs * fit$sigma)), 1e-4)
  one <- fit_of()
  compare(group, "likelihood ratio", found$level_variances$test$statistic, 2 * as.numeric(logLik(fit) - logLik(one)), 1e-6)
  compare(group, "p of it", found$level_variances$test$p, anova(fit, one)[["p-value"]][2], 1e-6)
  effects <- unlist(lapply(ranef(fit, level = seq_along(fit$modelStruct$reStruct), simplify = FALSE), unlist))
  if (length(fit$modelStruct$reStruct) == 1) effects <- unlist(ranef(fit))
  compare(group, "effects of groups", sort(found$effects$value), sort(unname(effects)), 1e-4)
  if (!is.null(means)) {
    answer <- ask(path, "--formula", shQuote(text), asked, "--means", means)$means
    grid <- emmeans(fit, means, data = table)
    theirs <- as.data.frame(grid)
    order <- match(unlist(answer$means[[1]]$levels), as.character(theirs[[means]]))
    compare(group, "means", c(answer$means[[1]]$mean, answer$means[[1]]$se), c(theirs$emmean[order], theirs$SE[order]), limit)
    pairs <- as.data.frame(contrast(grid, "revpairwise"))
    compare(group, "differences", sort(abs(answer$differences[[1]]$t)), sort(abs(pairs$t.ratio)), limit)
  }
}
plain <- function(table) {
  table <- as.data.frame(table)
  categories <- vapply(table, is.factor, TRUE)
  table[categories] <- lapply(table[categories], as.character)
  table
}
children <- plain(nlme::Orthodont)
check_mixed_levels("mixed levels: Orthodont", children, distance ~ age * Sex, list(Subject = ~ 1), "distance ~ age * Sex + (1 | Subject)", "Sex", means = "Sex")
check_mixed_levels("mixed levels: Orthodont, slopes", children, distance ~ age * Sex, list(Subject = ~ age), "distance ~ age * Sex + (1 + age | Subject)", "Sex", means = "Sex")
check_mixed_levels("mixed levels: Orthodont by ML", children, distance ~ age + Sex, list(Subject = ~ 1), "distance ~ age + Sex + (1 | Subject)", "Sex", TRUE)
whole <- plain(nlme::Machines)
whole$Worker <- paste0("w", whole$Worker)
check_mixed_levels("mixed levels: Machines", whole, score ~ Machine, list(Worker = ~ 1), "score ~ Machine + (1 | Worker)", "Machine", means = "Machine")
check_mixed_levels("mixed levels: Machines, unbalanced", whole[-c(2, 3, 6, 8, 9, 12, 19, 20, 27, 33), ], score ~ Machine, list(Worker = ~ 1), "score ~ Machine + (1 | Worker)", "Machine", means = "Machine")
oats <- plain(nlme::Oats)
check_mixed_levels("mixed levels: Oats", oats, yield ~ nitro + Variety, list(Block = ~ 1, Variety = ~ 1), "yield ~ nitro + Variety + (1 | Block / Variety)", "Variety", means = "Variety")
rats <- plain(nlme::BodyWeight)
rats$Diet <- paste0("d", rats$Diet)
rats$Rat <- paste0("r", rats$Rat)
check_mixed_levels("mixed levels: BodyWeight", rats, weight ~ Time * Diet, list(Rat = ~ Time), "weight ~ Time * Diet + (1 + Time | Rat)", "Diet")
flow <- plain(nlme::Dialyzer)
flow$QB <- paste0("q", flow$QB)
check_mixed_levels("mixed levels: Dialyzer", flow, rate ~ pressure + I(pressure^2) + QB, list(Subject = ~ 1), "rate ~ pressure + pressure^2 + QB + (1 | Subject)", "QB", means = "QB")
impact_levels <- transform(impacts, y = k + c(0, 2)[factor(variety)] * scale(seq_along(k) * 7919 %% 13)[, 1])
check_mixed_levels("mixed levels: impacts", impact_levels, y ~ V * variety + R, list(specimen = ~ 1), "y ~ V * variety + R + (1 | specimen)", "variety", means = "variety")
