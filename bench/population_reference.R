# Reference numbers for crates/identify/tests/population.rs, from packages independent
# of windfall: Rscript bench/population_reference.R OUTPUT_DIRECTORY
#
# linear.csv, linear.txt    impacts as normal observations with known covariance;
#                           ML: nlme::lme on whitened rows with residual sigma 1,
#                           REML: dense matrices and optim
# poisson.csv, poisson.txt  counts with normal effects; lme4::glmer, Laplace and
#                           25-point adaptive quadrature
# growth.csv, growth.txt    logistic growth of trees (nonlinear, known sigma);
#                           nlme::nlme
suppressMessages({library(nlme); library(lme4)})
out <- commandArgs(trailingOnly = TRUE)[1]
say <- function(name, ...) cat(sprintf("%s %.12g\n", name, c(...)), sep = "")

## Two parameters, 15 fruit with 1 to 5 impacts, one covariate.
set.seed(20260)
numbers <- rep(1:5, 3)
fruit <- rep(seq_along(numbers), numbers)
n <- length(fruit)
x <- round(runif(n, -1, 1), 3)
chol_between <- chol(matrix(c(0.15^2, 0.4 * 0.15 * 0.2, 0.4 * 0.15 * 0.2, 0.2^2), 2))
b <- matrix(rnorm(2 * length(numbers)), ncol = 2) %*% chol_between
e <- matrix(rnorm(2 * n, sd = 0.08), ncol = 2)
rows <- NULL; data <- NULL
for (i in 1:n) {
  sds <- runif(2, 0.02, 0.06); r <- runif(1, -0.7, 0.7)
  v <- diag(sds) %*% matrix(c(1, r, r, 1), 2) %*% diag(sds)
  z <- c(13, 7) + c(-0.1, 0.15) * x[i] + b[fruit[i], ] + e[i, ] + drop(t(chol(v)) %*% rnorm(2))
  z <- round(z, 6); v <- signif(v, 8); v[2, 1] <- v[1, 2]
  data <- rbind(data, c(fruit[i] - 1, x[i], z, v[1, 1], v[1, 2], v[2, 2]))
  w <- solve(t(chol(v)))
  m <- diag(2)
  rows <- rbind(rows, data.frame(
    fruit = fruit[i], impact = i, y = drop(w %*% z),
    f1 = w[, 1], f1x = w[, 1] * x[i], f2 = w[, 2], f2x = w[, 2] * x[i],
    r1 = w[, 1], r2 = w[, 2]))
}
write.table(data, file.path(out, "linear.csv"), sep = ",", row.names = FALSE,
            col.names = c("fruit", "x", "z1", "z2", "v11", "v12", "v22"))
sink(file.path(out, "linear.txt"))
fit <- lme(y ~ f1 + f1x + f2 + f2x - 1, data = rows,
           random = list(fruit = pdSymm(~ r1 + r2 - 1), impact = pdSymm(~ r1 + r2 - 1)),
           method = "ML",
           control = lmeControl(sigma = 1, maxIter = 500, msMaxIter = 2000, tolerance = 1e-10,
                                msTol = 1e-12, niterEM = 50, opt = "nlminb"))
# log-likelihood of z: that of the whitened rows plus log det of the weights
weights <- -0.5 * sum(log(data[, 5] * data[, 7] - data[, 6]^2))
say("ML.effect", fixef(fit))
between <- as.matrix(pdMatrix(fit$modelStruct$reStruct$fruit))
within <- as.matrix(pdMatrix(fit$modelStruct$reStruct$impact))
say("ML.between", between[c(1, 2, 4)])
say("ML.within", within[c(1, 2, 4)])
say("ML.loglik", as.numeric(logLik(fit)) + weights)
# nlme 3.1-162 stops 0.045 short of the maximum of the restricted likelihood
# when sigma is held: dense matrices and optim instead.
restricted <- function(between, within) {
  size <- 2 * n
  sigma <- matrix(0, size, size); design <- matrix(0, size, 4)
  z <- as.vector(t(data[, 3:4]))
  for (i in 1:n) {
    own <- 2 * i - 1:0
    for (j in 1:n) if (fruit[i] == fruit[j]) sigma[own, 2 * j - 1:0] <- between
    sigma[own, own] <- sigma[own, own] + within + matrix(data[i, c(5, 6, 6, 7)], 2)
    design[own[1], 1:2] <- design[own[2], 3:4] <- c(1, x[i])
  }
  inverse <- solve(sigma)
  normal <- t(design) %*% inverse %*% design
  effects <- solve(normal, t(design) %*% inverse %*% z)
  r <- z - design %*% effects
  deviance <- determinant(sigma)$modulus + determinant(normal)$modulus +
    t(r) %*% inverse %*% r + (size - 4) * log(2 * pi)
  list(loglik = -as.numeric(deviance) / 2, effects = effects, covariance = solve(normal))
}
pair <- function(t) { l <- matrix(c(t[1], t[2], 0, t[3]), 2); l %*% t(l) }
target <- function(t) -restricted(pair(t[1:3]), pair(t[4:6]))$loglik
best <- optim(c(0.14, 0.06, 0.13, 0.08, -0.01, 0.1), target, method = "BFGS",
              control = list(reltol = 1e-15, maxit = 1000, ndeps = rep(1e-5, 6)))
at <- restricted(pair(best$par[1:3]), pair(best$par[4:6]))
say("REML.effect", at$effects)
say("REML.se", sqrt(diag(at$covariance)))
say("REML.between", pair(best$par[1:3])[c(1, 2, 4)])
say("REML.within", pair(best$par[4:6])[c(1, 2, 4)])
say("REML.loglik", at$loglik)
# profile likelihood: the standard deviation of the first parameter between fruit
rise <- function(sd) {
  held <- function(t) target(c(sd, t))
  2 * (optim(best$par[-1], held, method = "BFGS", control = list(reltol = 1e-13, maxit = 500))$value -
       best$value) - qchisq(0.95, 1)
}
say("REML.profile", c(uniroot(rise, c(0.07, 0.14), tol = 1e-6)$root,
                      uniroot(rise, c(0.15, 0.35), tol = 1e-6)$root))
sink()

## Counts: small ones, so that each likelihood is far from normal.
set.seed(7)
fruit <- rep(1:30, length.out = 100); fruit <- sort(fruit)
x <- round(runif(length(fruit), -1, 1), 3)
y <- rpois(length(fruit), exp(0.7 + 0.5 * x + rnorm(30, sd = 0.6)[fruit]))
write.table(data.frame(fruit = fruit - 1, x = x, y = y), file.path(out, "poisson.csv"),
            sep = ",", row.names = FALSE)
sink(file.path(out, "poisson.txt"))
for (points in c(1, 25)) {
  fit <- glmer(y ~ x + (1 | fruit), family = poisson, nAGQ = points,
               control = glmerControl(optimizer = "bobyqa", optCtrl = list(rhoend = 1e-10, maxfun = 1e5)))
  name <- paste0("points", points)
  say(paste0(name, ".effect"), fixef(fit))
  say(paste0(name, ".sd"), sqrt(VarCorr(fit)$fruit[1, 1]))
  say(paste0(name, ".loglik"), as.numeric(logLik(fit)))
}
sink()

## Logistic growth of trees (nlme's Orange: Draper and Smith 1998, exercise 24.N),
## log asymptote, log midpoint and log scale; all three vary.
sink(file.path(out, "growth.txt"))
Orange$tree <- as.integer(as.character(Orange$Tree))
fit <- nlme(circumference ~ exp(a) / (1 + exp((exp(m) - age) / exp(s))), data = Orange,
            fixed = a + m + s ~ 1, random = pdDiag(a + m + s ~ 1), groups = ~tree,
            start = c(a = log(190), m = log(720), s = log(350)), method = "ML",
            control = nlmeControl(sigma = 8, tolerance = 1e-6, pnlsTol = 1e-6, maxIter = 500,
                                  pnlsMaxIter = 100, msMaxIter = 1000, msTol = 1e-12))
say("effect", fixef(fit))
say("sd", sqrt(diag(pdMatrix(fit$modelStruct$reStruct$tree) * 64)))
say("loglik", as.numeric(logLik(fit)))
sink()
write.table(data.frame(fruit = Orange$tree - 1, age = Orange$age, y = Orange$circumference),
            file.path(out, "growth.csv"), sep = ",", row.names = FALSE)
