# Generates the reference numbers for mixed models whose residual variance differs by level:
#
#   Rscript bench/mixed_levels_reference.R
#
# Likelihoods are compared with nlme::lme and varIdent where groups are nested. Everything else
# is calculated from the rows' full covariance matrices: Fisher's scoring to rounding, Kenward
# and Roger's (1997) covariance, degrees of freedom and F, and Satterthwaite's from the observed
# information. Where a model falls into two that share nothing, lme4 and pbkrtest of each part
# are the reference.
suppressMessages({
  library(nlme)
  library(jsonlite)
  library(lme4)
  library(pbkrtest)
})
folder <- "crates/mixed/tests/data"
table_of <- function(name) read.csv(file.path(folder, paste0(name, ".csv")), stringsAsFactors = TRUE)
options(contrasts = c("contr.sum", "contr.poly"))

# One symmetric pattern for each entry of the covariance of a term, in the order of the lower
# triangle by columns
patterns <- function(columns, group) {
  same <- outer(group, group, "==")
  q <- ncol(columns)
  out <- list()
  for (j in 1:q) for (i in j:q) {
    g <- outer(columns[, i], columns[, j])
    g <- if (i == j) g else g + t(g)
    out[[length(out) + 1]] <- g * same
  }
  out
}

dense <- function(y, x, g, start, restricted) {
  phi <- start
  n <- length(y)
  for (step in 1:500) {
    v <- Reduce(`+`, Map(`*`, g, phi))
    w <- solve(v)
    wx <- w %*% x
    covariance <- solve(crossprod(x, wx))
    p <- w - wx %*% covariance %*% t(wx)
    py <- p %*% y
    m <- if (restricted) p else w
    mg <- lapply(g, function(own) m %*% own)
    score <- sapply(seq_along(g), function(r)
      0.5 * (drop(t(py) %*% g[[r]] %*% py) - sum(diag(mg[[r]]))))
    information <- outer(seq_along(g), seq_along(g), Vectorize(function(r, s)
      0.5 * sum(mg[[r]] * t(mg[[s]]))))
    change <- solve(information, score)
    while (any(eigen(Reduce(`+`, Map(`*`, g, phi + change)), symmetric = TRUE, only.values = TRUE)$values <= 0)) change <- change / 2
    phi <- phi + change
    if (max(abs(change / pmax(abs(phi), 1e-3 * max(abs(phi))))) < 1e-13) break
  }
  observed <- outer(seq_along(g), seq_along(g), Vectorize(function(r, s)
    drop(t(py) %*% g[[r]] %*% p %*% g[[s]] %*% py) - 0.5 * sum(mg[[r]] * t(mg[[s]]))))
  log_det <- function(a) as.numeric(determinant(a)$modulus)
  k <- n - if (restricted) ncol(x) else 0
  quadratic <- drop(t(y) %*% py)
  deviance <- log_det(v) + k * log(2 * pi) + quadratic +
    if (restricted) log_det(crossprod(x, wx)) else 0
  list(phi = phi, v = v, w = w, wx = wx, covariance = covariance, information = information,
    observed = observed, beta = drop(covariance %*% crossprod(wx, y)), log_likelihood = -deviance / 2)
}

# Kenward and Roger (1997), of a covariance that is linear in its parameters
kenward_roger <- function(x, g, fit) {
  phi <- fit$covariance
  w <- fit$w
  count <- length(g)
  slopes <- lapply(g, function(own) -crossprod(fit$wx, own %*% fit$wx))
  weights <- solve(fit$information)
  middle <- 0
  for (r in 1:count) for (s in 1:count) {
    q <- crossprod(fit$wx, g[[r]] %*% w %*% g[[s]] %*% fit$wx)
    middle <- middle + weights[r, s] * (q - slopes[[r]] %*% phi %*% slopes[[s]])
  }
  adjusted <- phi + 2 * phi %*% middle %*% phi
  test <- function(l) {
    q <- nrow(l)
    theta <- t(l) %*% solve(l %*% phi %*% t(l)) %*% l
    turned <- lapply(slopes, function(own) theta %*% phi %*% own %*% phi)
    trace <- function(a) sum(diag(a))
    a1 <- a2 <- 0
    for (r in 1:count) for (s in 1:count) {
      a1 <- a1 + weights[r, s] * trace(turned[[r]]) * trace(turned[[s]])
      a2 <- a2 + weights[r, s] * trace(turned[[r]] %*% turned[[s]])
    }
    b <- (a1 + 6 * a2) / (2 * q)
    h <- ((q + 1) * a1 - (q + 4) * a2) / ((q + 2) * a2)
    d <- 3 * q + 2 * (1 - h)
    c1 <- h / d
    c2 <- (q - h) / d
    c3 <- (q + 2 - h) / d
    mean <- 1 / (1 - a2 / q)
    variance <- 2 / q * (1 + c1 * b) / ((1 - c2 * b)^2 * (1 - c3 * b))
    rho <- variance / (2 * mean^2)
    df <- 4 + (q + 2) / (q * rho - 1)
    scaling <- df / (mean * (df - 2))
    value <- l %*% fit$beta
    wald <- drop(t(value) %*% solve(l %*% adjusted %*% t(l)) %*% value) / q
    list(df = df, f = scaling * wald)
  }
  list(covariance = adjusted, test = test)
}

satterthwaite <- function(g, fit, l) {
  slope <- sapply(g, function(own) {
    lower <- crossprod(fit$wx, own %*% fit$wx)
    drop(l %*% fit$covariance %*% lower %*% fit$covariance %*% l)
  })
  variance <- drop(l %*% fit$covariance %*% l)
  2 * variance^2 / drop(slope %*% solve(fit$observed, slope))
}

# --- cases: table, fixed formula, terms (columns, groups), level of each row ---
one <- function(name, fixed, terms, level, peer = NULL, joint) {
  data <- table_of(name)
  data$level_of_row <- factor(level(data))
  y <- data[[all.vars(fixed)[1]]]
  x <- model.matrix(fixed, data)
  levels <- levels(data$level_of_row)
  g <- unlist(lapply(terms, function(own) patterns(model.matrix(own$columns, data),
    do.call(paste, c(data[own$groups], sep = ":")))), recursive = FALSE)
  residual <- lapply(levels, function(own) diag(as.numeric(data$level_of_row == own)))
  everything <- c(g, residual)
  out <- list(table = name, names = levels, level = as.integer(data$level_of_row) - 1L)
  for (method in c("reml", "ml")) {
    start <- c(unlist(lapply(terms, `[[`, "start")), rep(0.5 * var(residuals(lm(fixed, data))), length(levels)))
    fit <- dense(y, x, everything, start, method == "reml")
    own <- list(coefficients = unname(fit$beta), covariance = unname(fit$covariance),
      variances = fit$phi, log_likelihood = fit$log_likelihood)
    equal <- dense(y, x, c(g, list(diag(length(y)))), start[seq_len(length(g) + 1)], method == "reml")
    own$equal_log_likelihood <- equal$log_likelihood
    unit <- diag(ncol(x))
    own$satterthwaite <- sapply(seq_len(ncol(x)), function(i) satterthwaite(everything, fit, unit[i, ]))
    if (method == "reml") {
      kr <- kenward_roger(x, everything, fit)
      own$kr_covariance <- unname(kr$covariance)
      own$kr_df <- sapply(seq_len(ncol(x)), function(i) kr$test(unit[i, , drop = FALSE])$df)
      own$joint <- joint - 1
      own$kr_joint <- unlist(kr$test(unit[joint, , drop = FALSE]))
    }
    if (!is.null(peer)) {
      found <- lme(fixed, random = peer, data = data, weights = varIdent(form = ~ 1 | level_of_row),
        method = toupper(method),
        control = lmeControl(msTol = 1e-12, tolerance = 1e-10, msMaxIter = 1000, maxIter = 1000, opt = "nlminb"))
      own$nlme <- as.numeric(logLik(found))
      stopifnot(abs(own$nlme - fit$log_likelihood) < 1e-5)
    }
    out[[method]] <- own
  }
  out
}

cases <- list(
  one("growth", y ~ day, list(list(columns = ~ day, groups = "subject", start = c(600, 10, 35))),
    function(d) ifelse(d$day < 5, "early", "late"), list(subject = ~ day), 2),
  one("apple", k ~ velocity + radius, list(list(columns = ~ 1, groups = "fruit", start = 5000)),
    function(d) cut(d$velocity, c(0, 0.35, 0.75, 2), labels = c("a", "b", "c")), list(fruit = ~ 1), 2:3),
  one("crossed", y ~ level, list(list(columns = ~ 1, groups = "fruit", start = 10),
      list(columns = ~ 1, groups = "operator", start = 3)),
    function(d) d$operator, NULL, 2),
  one("nested", y ~ side, list(list(columns = ~ 1, groups = c("fruit", "variety"), start = 10),
      list(columns = ~ 1, groups = "variety", start = 10)),
    function(d) d$side, list(variety = ~ 1, fruit = ~ 1), 2:3),
  one("split", y ~ storage + height + storage:height, list(
      list(columns = ~ 1, groups = c("orchard", "storage"), start = 5),
      list(columns = ~ 1, groups = "orchard", start = 5)),
    function(d) d$height, list(orchard = ~ 1, storage = ~ 1), 5:6)
)

# The sides of two groups of subjects, each with its own line, random line and residual variance
halves <- {
  data <- table_of("growth")
  data$half <- factor(ifelse(as.integer(data$subject) <= 9, "a", "b"))
  part <- function(own) {
    strict <- lmerControl(optimizer = "bobyqa", optCtrl = list(rhoend = 1e-10, maxfun = 1e5))
    fit <- lmer(y ~ day + (1 | subject), data[data$half == own, ], control = strict)
    adjusted <- vcovAdj(fit)
    list(coefficients = unname(fixef(fit)), sigma = sigma(fit), between = attr(VarCorr(fit)$subject, "stddev")[[1]],
      log_likelihood = as.numeric(logLik(fit)), kr_se = sqrt(diag(as.matrix(adjusted))),
      kr_df = sapply(1:2, function(i) Lb_ddf(as.numeric(1:2 == i), vcov(fit), adjusted)))
  }
  lapply(c("a", "b"), part)
}
versions <- sapply(c("nlme", "lme4", "pbkrtest"), function(p) as.character(packageVersion(p)))
write(toJSON(list(versions = as.list(versions), cases = cases, halves = halves),
  digits = NA, auto_unbox = TRUE), file.path(folder, "levels.json"))
