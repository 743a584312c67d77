# Regression with a data frame and a formula of R.

wf_regress <- function(data, formula, ...) {
  model <- model_words(formula, data)
  data <- model$data
  result <- windfall("regress", data, formula = model$formula, random = model$random,
                     levels = model$levels, ...)
  result$terms <- frame_of(result$terms)
  result$anova <- frame_of(result$anova)
  result$influence <- frame_of(result$influence)
  names <- result$terms$term
  result$covariance <- matrix(unlist(result$covariance), length(names),
                              dimnames = list(names, names))
  class(result) <- "windfall_regression"
  result
}

coef.windfall_regression <- function(object, ...) {
  setNames(object$terms$estimate, object$terms$term)
}

vcov.windfall_regression <- function(object, ...) object$covariance

print.windfall_regression <- function(x, ...) {
  cat(x$formula, " (", x$rows, " rows)\n\n", sep = "")
  print(x$terms, row.names = FALSE, ...)
  if (is.numeric(x$r2)) {
    cat("\nR-squared ", format(x$r2), ", adjusted ", format(x$r2_adjusted), "\n", sep = "")
  }
  for (finding in x$findings) cat(finding$code, ": ", finding$message, "\n", sep = "")
  invisible(x)
}

# What R means by a formula, in words that windfall takes to mean the same: "a^2" is
# a power there and a crossing here, and "." is not known there.
model_words <- function(formula, data) {
  if (!inherits(formula, "formula") || length(formula) != 3) {
    stop("formula: expected a formula with a response, such as k ~ velocity + fruit", call. = FALSE)
  }
  meant <- terms(categories(formula), data = data)
  if (!is.null(attr(meant, "offset"))) {
    stop("formula: windfall knows no offset; subtract it from the response", call. = FALSE)
  }
  labels <- attr(meant, "term.labels")
  random <- grepl("|", labels, fixed = TRUE)
  right <- paste(c(attr(meant, "intercept"), labels[!random]), collapse = " + ")
  left <- paste(deparse(formula[[2]], width.cutoff = 500), collapse = " ")
  # Texts and truth values are factors to lm.
  turned <- vapply(data, function(column) is.character(column) || is.logical(column), NA)
  data[turned] <- lapply(data[turned], factor)
  list(formula = paste(left, "~", right), random = labels[random], data = data,
       levels = level_words(data, all.vars(meant)))
}

# A formula in which factor(x) is C(x), as windfall calls it.
categories <- function(part) {
  if (!is.call(part)) return(part)
  if (is.name(part[[1]]) && as.character(part[[1]]) %in% c("factor", "as.factor")) {
    part[[1]] <- as.name("C")
  }
  part[-1] <- lapply(as.list(part)[-1], categories)
  part
}

# The levels of each factor in the order that R has them, the reference first.
level_words <- function(data, used) {
  factors <- Filter(function(name) is.factor(data[[name]]), intersect(names(data), used))
  vapply(factors, function(name) {
    levels <- levels(droplevels(data[[name]]))
    commas <- grepl("[,`]", levels)
    levels[commas] <- paste0("`", levels[commas], "`")
    paste0(name, "=", paste(levels, collapse = ","))
  }, "", USE.NAMES = FALSE)
}

# Rows with the same keys as a data frame; what is not given is NA.
frame_of <- function(rows) {
  if (length(rows) == 0) return(data.frame())
  keys <- unique(unlist(lapply(rows, names)))
  columns <- lapply(keys, function(key) {
    cells <- lapply(rows, function(row) if (is.null(row[[key]])) NA else row[[key]])
    if (all(lengths(cells) == 1)) unlist(cells) else I(cells)
  })
  names(columns) <- keys
  as.data.frame(columns, check.names = FALSE, stringsAsFactors = FALSE)
}
