function [result, messages] = windfall(varargin)
%WINDFALL  Run a command of windfall and return its result.
%   R = WINDFALL(COMMAND, ARGUMENT, ...) runs the program with the arguments of
%   its command line and returns what --format json says as a struct. All numbers
%   there are SI. Arguments are text or numbers; numbers of an array follow each
%   other.
%
%   [R, MESSAGES] = WINDFALL(...) also returns what the command says beside its
%   result, a cell array of lines.
%
%   With another --format, and for the few commands that have no JSON, R is the
%   text that is printed.
%
%   Arrays of objects with the same keys become struct arrays, null becomes [],
%   and keys that are no names of MATLAB are changed, as jsondecode does it. That
%   of Octave rounds the last bit of a number; tables that are read have all.
%
%   The program is the one that the environment variable WINDFALL names, else the
%   one on the search path: setenv('WINDFALL', '/path/to/windfall').
%
%   A wrong request is an error 'windfall:request', work that failed one
%   'windfall:failed'; the message has the words of the command. If there is no
%   program, the error is 'windfall:missing'.
%
%   Examples
%      r = windfall('regress', 'table.csv', '--formula', 'k ~ velocity + fruit');
%      struct2table(r.terms)                       % MATLAB
%
%      windfall('simulate', 'pendulum', '--example', 'study');
%      study = windfall('fit', 'study', '--law', 'kuwabara-kono');
%      k = arrayfun(@(impact) impact.parameters.k.value, study.impacts);
%
%      windfall('fit', 'study', '--out', 'fits.csv');
%      fits = readtable('fits.csv');               % MATLAB: a row for each impact
%
%   On Windows the shell replaces %NAME% in arguments by the value of the
%   environment variable NAME, if there is one.

    words = {};
    for place = 1:nargin
        words = [words, words_of(varargin{place})]; %#ok<AGROW>
    end

    % JSON, unless the caller asks for another form.
    formatted = any(strncmp(words, '--format', 8));
    if formatted
        [status, output, errors] = run(words);
    else
        [status, output, errors] = run(as_json(words));
        % Few commands have no other form than text. They say so before they do anything.
        if strncmp(errors, 'error: unexpected argument ''--format'' found', 42)
            formatted = true;
            [status, output, errors] = run(words);
        end
    end

    if status ~= 0
        fail(status, errors);
    end
    messages = lines_of(errors);
    if formatted
        result = output;
    else
        result = jsondecode(output);
    end
end

function words = words_of(value)
    if isnumeric(value) || islogical(value)
        words = arrayfun(@number_text, value(:).', 'UniformOutput', false);
    elseif ischar(value)
        words = {value};
    elseif iscellstr(value) || isa(value, 'string') %#ok<ISCLSTR>
        words = reshape(cellstr(value), 1, []);
    else
        error('windfall:request', 'expected text or numbers, found %s', class(value));
    end
end

function text = number_text(value)
    % All digits that a double has, and no more than it needs.
    value = double(value);
    text = sprintf('%.15g', value);
    if str2double(text) ~= value
        text = sprintf('%.17g', value);
    end
end

function words = as_json(words)
    % Behind "--" there are no options any more.
    last = find(strcmp(words, '--'), 1);
    if isempty(last)
        last = numel(words) + 1;
    end
    words = [words(1:last - 1), {'--format', 'json'}, words(last:end)];
end

function [status, output, errors] = run(words)
    program = getenv('WINDFALL');
    if isempty(program)
        program = 'windfall';
    elseif exist(program, 'file') ~= 2
        error('windfall:missing', ...
            'there is no program "%s", which the environment variable WINDFALL names', program);
    end
    % Output goes through files: what system() returns depends on the code page.
    base = tempname();
    files = {[base '.out'], [base '.err']};
    cleaner = onCleanup(@() remove(files)); %#ok<NASGU>
    quoted = cellfun(@quote, [{program}, words, files], 'UniformOutput', false);
    line = [strjoin(quoted(1:end - 2), ' ') ' > ' quoted{end - 1} ' 2> ' quoted{end}];
    if ispc() && exist('OCTAVE_VERSION', 'builtin')
        % cmd.exe takes off the outermost quotation marks.
        line = ['"' line '"'];
    end
    status = system(line);
    output = text_of(files{1});
    errors = text_of(files{2});
    % The shell of Unix says it by the status, that of Windows only in its language.
    if status == 127 || (ispc() && status ~= 0 && isempty(strfind(errors, 'error: ')))
        error('windfall:missing', ['there is no program %s on the search path; name it with ' ...
            'setenv(''WINDFALL'', ''/path/to/windfall'')'], program);
    end
end

function word = quote(word)
    if ispc()
        % As the C library cuts command lines: backslashes before a quotation mark are doubled.
        word = regexprep(word, '(\\*)"', '$1$1\\"');
        word = ['"' regexprep(word, '(\\+)$', '$1$1') '"'];
    else
        word = ['''' strrep(word, '''', '''\''''') ''''];
    end
end

function text = text_of(file)
    [handle, reason] = fopen(file, 'r', 'n', 'UTF-8');
    if handle < 0
        error('windfall:failed', 'cannot read %s: %s', file, reason);
    end
    text = fread(handle, [1, Inf], '*char');
    fclose(handle);
    text = strrep(text, sprintf('\r\n'), sprintf('\n'));
end

function remove(files)
    for place = 1:numel(files)
        if exist(files{place}, 'file') == 2
            delete(files{place});
        end
    end
end

function lines = lines_of(text)
    lines = strsplit(text, sprintf('\n'));
    lines = lines(~cellfun(@isempty, lines));
end

function fail(status, errors)
    lines = strsplit(strtrim(errors), sprintf('\n'));
    % Of several errors the last one is that of the command itself.
    own = find(strncmp(lines, 'error: ', 7), 1, 'last');
    if ~isempty(own)
        lines{own} = lines{own}(8:end);
        lines = [lines(own:end), lines(1:own - 1)];
    end
    text = strjoin(lines, sprintf('\n'));
    if isempty(text)
        text = sprintf('windfall ended with status %d', status);
    end
    if status == 2
        error('windfall:request', '%s', text);
    end
    error('windfall:failed', '%s', text);
end
