# Questions after the model against emmeans: marginal means, slopes at levels, contrasts with adjusted
# p, tests of equality, values on the response's own scale. Unbalanced tables with covariates,
# interactions, missing cells, and mixed models by both kinds of degrees of freedom.
# Part of compare_statistics.R.

key_of <- function(table, columns) do.call(paste, c(lapply(table[columns], as.character), sep = " "))

# of, within: categories; which: as --compare, or a list of named weights; slope: column of numbers.
check_means <- function(group, table, formula, of, within = NULL, which = "pairs", adjust = NULL,
                        mixed = NULL, slope = NULL, at = NULL, levels = NULL) {
  path <- write_table(group, table)
  for (name in names(levels)) table[[name]] <- factor(table[[name]], levels[[name]])
  text <- shQuote(paste(deparse(formula, width.cutoff = 500), collapse = ""))
  asked <- paste(c(slope, of), collapse = ",")
  if (!is.null(within)) asked <- paste(asked, "|", paste(within, collapse = ","))
  options <- c(if (is.null(slope)) "--means" else "--slopes", shQuote(asked), if (is.null(mixed)) "--folds 0" else c("--df", mixed))
  sums <- if (is.list(which)) paste0(names(which), "=", vapply(which, paste, "", collapse = ",")) else which
  for (one in sums) options <- c(options, "--compare", shQuote(one))
  for (name in names(levels)) options <- c(options, "--levels", shQuote(paste0(name, "=", paste(levels[[name]], collapse = ","))))
  if (!is.null(adjust)) options <- c(options, "--adjust", adjust)
  for (name in names(at)) options <- c(options, "--at", paste0(name, "=", at[[name]]))
  found <- ask(path, "--formula", text, options)$means
  fit <- do.call(if (is.null(mixed)) lm else lmer, list(formula, table))
  df <- if (is.null(mixed)) "satterthwaite" else mixed
  call <- list(fit, of, by = within, at = at, lmer.df = df)
  if (length(of) == 0) call[[2]] <- ~1
  grid <- do.call(if (is.null(slope)) emmeans else emtrends, c(call, if (!is.null(slope)) list(var = slope, delta.var = 2e-8)))
  # Slopes of emmeans are differences over a step.
  limit <- if (!is.null(mixed)) 1e-5 else if (!is.null(slope)) 1e-6 else 1e-8
  own <- as.data.frame(summary(grid, infer = TRUE))
  means <- found$means[[1]]
  order <- if (length(c(of, within)) == 0) 1 else match(vapply(means$levels, paste, "", collapse = " "), key_of(own, c(within, of)))
  value <- if (is.null(slope)) "emmean" else paste0(slope, ".trend")
  known <- sum(!is.na(own[[value]]))
  stopifnot(nrow(means) == known, !anyNA(order))
  compare(group, "mean", means$mean, own[[value]][order], limit)
  compare(group, "standard error", means$se, own$SE[order], limit)
  compare(group, "degrees of freedom", means$df, own$df[order], limit)
  width <- rep(means$high - means$low, 2)
  compare(group, "interval", 1 + c(means$low, means$high) / width, 1 + c(own$lower.CL[order], own$upper.CL[order]) / width, limit)
  if (!is.na(found$original[1])) {
    own <- as.data.frame(summary(grid, infer = TRUE, type = "response"))
    own$value <- if ("response" %in% names(own)) own$response else own$emmean
    compare(group, "on the own scale", c(means$original$value, means$original$low, means$original$high), c(own$value[order], own$lower.CL[order], own$upper.CL[order]), limit)
  }
  differences <- found$differences[[1]]
  if (length(differences) == 0) return(invisible())
  method <- if (is.list(which)) which else if (which == "pairs") "revpairwise" else
    if (which == "mean") "eff" else if (which == "polynomial") "poly" else "trt.vs.ctrl"
  usual <- if (is.list(which) || which == "polynomial") "none" else if (which == "pairs") "tukey" else "mvt"
  adjust <- if (is.null(adjust)) usual else if (adjust == "t") "mvt" else adjust
  arguments <- list(grid, method, adjust = adjust)
  if (is.character(which) && grepl("^control=", which)) arguments$ref <- match(sub("control=", "", which), levels(grid)[[of]])
  theirs <- as.data.frame(summary(do.call(contrast, arguments), infer = TRUE))
  theirs <- theirs[!is.na(theirs$estimate), ]
  labels <- gsub("[()]", "", sub(" effect$", " - mean of all", as.character(theirs$contrast)))
  prefix <- if (is.null(within)) rep("", nrow(theirs)) else paste0(key_of(theirs, within), ": ")
  wanted <- if (is.null(within)) rep("", nrow(differences)) else paste0(vapply(differences$within, paste, "", collapse = " "), ": ")
  turned <- vapply(strsplit(differences$contrast, " - "), function(own) paste(rev(own), collapse = " - "), "")
  place <- match(paste0(wanted, differences$contrast), paste0(prefix, labels))
  sign <- ifelse(is.na(place), -1, 1)
  place <- ifelse(is.na(place), match(paste0(wanted, turned), paste0(prefix, labels)), place)
  stopifnot(nrow(differences) == nrow(theirs), !anyNA(place))
  compare(group, "difference", differences$difference, sign * theirs$estimate[place], limit)
  compare(group, "its standard error", differences$se, theirs$SE[place], limit)
  compare(group, "its degrees of freedom", differences$df, theirs$df[place], limit)
  ends <- c(differences$low, differences$high)
  expected <- c(ifelse(sign > 0, theirs$lower.CL[place], -theirs$upper.CL[place]), ifelse(sign > 0, theirs$upper.CL[place], -theirs$lower.CL[place]))
  if (adjust == "mvt") {
    # emmeans asks mvtnorm for three digits; here it is asked for six. Its degrees of freedom are
    # whole: between two of them by their inverse. Where its own error is above 1e-4, that is the limit.
    all <- do.call(contrast, arguments)
    known <- !is.na(as.data.frame(all)$estimate)
    block <- if (is.null(within)) rep(1, nrow(theirs)) else key_of(theirs, within)
    correlation <- cov2cor(vcov(all)[known, known])
    upper <- function(t, df, corr) {
      at <- function(df) {
        set.seed(1)
        found <- mvtnorm::pmvt(rep(-t, nrow(corr)), rep(t, nrow(corr)), df = df, corr = corr, algorithm = mvtnorm::GenzBretz(maxpts = 1e6, abseps = 1e-5))
        error <<- max(error, attr(found, "error"))
        1 - found[1]
      }
      low <- floor(df + 1e-6)
      if (abs(df - low) < 1e-6) return(at(low))
      part <- (1 / df - 1 / low) / (1 / (low + 1) - 1 / low)
      (1 - part) * at(low) + part * at(low + 1)
    }
    p <- critical <- numeric(nrow(theirs))
    error <- 0
    tried <- seq_len(min(nrow(theirs), 6))
    for (row in tried) {
      own <- which(block == block[row])
      mine <- match(row, place)
      corr <- correlation[own, own, drop = FALSE]
      p[row] <- upper(abs(theirs$t.ratio[row]), theirs$df[row], corr)
      reach <- (differences$high[mine] - differences$difference[mine]) / differences$se[mine]
      critical[row] <- upper(reach, theirs$df[row], corr)
    }
    compare(group, "p of differences", 1 + differences$p[match(tried, place)], 1 + p[tried], max(1e-4, error))
    compare(group, "interval of differences", 1 + critical[tried], rep(1.05, length(tried)), max(1e-4, error))
  } else if (adjust == "tukey") {
    # R's ptukey is off by up to 1e-5, where windfall's agrees with SciPy's to 1e-10.
    compare(group, "p of differences", 1 + differences$p, 1 + theirs$p.value[place], 1e-5)
    width <- rep(differences$high - differences$low, 2)
    compare(group, "interval of differences", 1 + ends / width, 1 + expected / width, 1e-5)
  } else {
    compare(group, "p of differences", differences$p, theirs$p.value[place], limit)
    if (adjust == "none") compare(group, "interval of differences", ends, expected, limit)
  }
  tests <- found$tests[[1]]
  # emmeans rounds F; its p is that of all digits. It joins Satterthwaite's degrees of freedom by
  # the smallest, windfall as lmerTest.
  if (length(tests) > 0 && is.null(slope) && !identical(mixed, "satterthwaite")) {
    joint <- as.data.frame(test(contrast(grid, "consec"), joint = TRUE))
    joint <- joint[!is.na(joint$F.ratio), ]
    place <- if (is.null(within)) 1 else match(vapply(tests$within, paste, "", collapse = " "), key_of(joint, within))
    if (is.null(mixed)) compare(group, "p of equality", tests$p, joint$p.value[place], 1e-8)
    else compare(group, "F of equality", tests$f, joint$F.ratio[place], 5e-3)
  }
}
set.seed(11)
fruit <- data.frame(
  variety = sample(c("Fuji", "Gala", "Idared", "Jonagold"), 200, TRUE, c(4, 3, 2, 1)),
  dose = sample(c("low", "mid", "high"), 200, TRUE, c(1, 2, 3)),
  lot = paste0("L", sample(1:12, 200, TRUE)), v = runif(200, 0.1, 0.6)
)
shift <- rnorm(12, sd = 2)
fruit$k <- signif(30 + 3 * as.integer(factor(fruit$variety)) + 2 * as.integer(factor(fruit$dose)) +
  8 * fruit$v + shift[as.integer(factor(fruit$lot))] + rnorm(200, sd = 2), 6)
emm_options(msg.interaction = FALSE, msg.nesting = FALSE)
fruit$row <- factor(sample(c("a", "b"), 200, TRUE))
few <- fruit[sort(sample(200, 45)), ]
holes <- subset(fruit, !(variety == "Gala" & dose == "mid") & !(variety == "Idared" & dose == "low"))
ordered <- list(dose = c("low", "mid", "high"))
check_means("means of one way", fruit, k ~ variety, "variety")
check_means("means of two ways with a covariate", fruit, k ~ variety + dose + v, "variety")
check_means("means of an interaction", fruit, k ~ variety * dose + v, c("variety", "dose"))
check_means("means over an interaction", fruit, k ~ variety * dose + v, "dose", adjust = "none")
check_means("means with a slope in each", fruit, k ~ variety * v + dose, "variety", adjust = "holm")
check_means("means of a logarithm", fruit, log(k) ~ variety + log(v), "variety")
check_means("means of a root", fruit, sqrt(k) ~ variety + dose, "dose")
check_means("means of three ways", fruit, k ~ variety * dose * row + v, c("dose", "row"), adjust = "holm")
check_means("means of few rows", few, k ~ variety + dose + v, "variety")
check_means("means at a value", fruit, k ~ variety * v, "variety", at = list(v = 0.5))
check_means("means at a value of a curve", fruit, k ~ variety * v + I(v^2), "variety", at = list(v = 0.15), adjust = "none")
check_means("means of a logarithm to base ten", fruit, log10(k) ~ variety * dose, "variety", adjust = "none")
check_means("simple effects", fruit, k ~ variety * dose + v, "variety", "dose")
check_means("simple effects the other way", fruit, k ~ variety * dose + v, "dose", "variety", adjust = "none")
check_means("simple effects of three ways", few, k ~ (variety + dose + row)^2, "dose", "row", adjust = "holm")
check_means("missing cells", holes, k ~ variety * dose, c("variety", "dose"), adjust = "none")
check_means("missing cells, simple effects", holes, k ~ variety * dose + v, "dose", "variety", adjust = "none")
check_means("missing cells without interaction", holes, k ~ variety + dose + v, "variety")
check_means("control", fruit, k ~ variety + dose + v, "variety", which = "control")
check_means("control of a level", fruit, k ~ variety + dose + v, "variety", which = "control=Idared")
check_means("control of few rows", few, k ~ variety, "variety", which = "control=Gala")
check_means("control by Holm", few, k ~ variety + v, "variety", which = "control", adjust = "holm")
check_means("control within", fruit, k ~ variety * dose, "variety", "dose", which = "control=Fuji")
check_means("against the mean", fruit, k ~ variety + dose, "variety", which = "mean")
check_means("against the mean of few rows", few, k ~ variety * v, "variety", which = "mean")
check_means("pairs by multivariate t", few, k ~ variety + dose + v, "variety", adjust = "t")
check_means("pairs of twelve by multivariate t", fruit, k ~ variety * dose, c("variety", "dose"), adjust = "t")
check_means("trends", fruit, k ~ variety + dose + v, "dose", which = "polynomial", levels = ordered)
check_means("trends within", fruit, k ~ variety * dose, "dose", "variety", which = "polynomial", levels = ordered, adjust = "holm")
check_means("sums of my own", fruit, k ~ variety + dose, "variety", which = list(`first two` = c(-0.5, -0.5, 0.5, 0.5), last = c(0, 0, -1, 1)))
check_means("sums by multivariate t", few, k ~ variety + dose, "variety", which = list(a = c(-0.5, -0.5, 0.5, 0.5), b = c(0, 0, -1, 1), c = c(-1, 1, 0, 0)), adjust = "t")
check_means("slopes", fruit, k ~ variety * v + dose, "variety", slope = "v")
check_means("slopes of a curve", fruit, k ~ variety * (v + I(v^2)), "variety", slope = "v", at = list(v = 0.3))
check_means("slope over all", fruit, k ~ variety * v + dose, character(), slope = "v")
check_means("slopes against a control", few, k ~ variety * v, "variety", slope = "v", which = "control")
check_means("slopes within", fruit, k ~ variety * dose * v, "variety", "dose", slope = "v", adjust = "holm")
check_means("slopes of a logarithm", fruit, log(k) ~ variety * log(v), "variety", slope = "v", at = list(v = 0.4), adjust = "none")
check_means("means, Satterthwaite", fruit, k ~ variety + dose + v + (1 | lot), "variety", mixed = "satterthwaite")
check_means("means, Kenward-Roger", fruit, k ~ variety * dose + (1 | lot), c("variety", "dose"), adjust = "none", mixed = "kenward-roger")
check_means("simple effects, Kenward-Roger", few, k ~ variety * dose + (1 | lot), "dose", "variety", adjust = "none", mixed = "kenward-roger")
check_means("control, Satterthwaite", fruit, k ~ variety + v + (1 | lot), "variety", which = "control", mixed = "satterthwaite")
check_means("slopes, Kenward-Roger", fruit, k ~ variety * v + (1 | lot), "variety", slope = "v", adjust = "holm", mixed = "kenward-roger")
check_means("trends, Satterthwaite", fruit, k ~ dose + v + (1 | lot), "dose", which = "polynomial", levels = ordered, mixed = "satterthwaite")
check_means("logarithm, Satterthwaite", fruit, log(k) ~ variety + v + (1 | lot), "variety", which = "control", mixed = "satterthwaite")
# Tables of other people: emmeans' and R's own.
pigs <- transform(emmeans::pigs, source = as.character(source), percent = paste0("p", percent))
protein <- list(percent = c("p9", "p12", "p15", "p18"))
check_means("pigs, trend of a logarithm", pigs, log(conc) ~ source + percent, "percent", which = "polynomial", levels = protein)
check_means("pigs, sources", pigs, log(conc) ~ source * percent, "source", "percent", levels = protein)
check_means("looms", transform(warpbreaks, wool = as.character(wool), tension = as.character(tension)), sqrt(breaks) ~ wool * tension, "tension", "wool", which = "control=L")
check_means("oats, Kenward-Roger", oats, yield ~ variety + nitro + (1 | block / variety), "variety", adjust = "holm", mixed = "kenward-roger")
