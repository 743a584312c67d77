function test_windfall()
%TEST_WINDFALL  Tests of windfall.m; an error if something is wrong.
%   The program is the one that windfall.m finds.

    folder = fullfile(tempname(), 'a "folder" of Käfer''s $HOME');
    if ispc()
        folder = fullfile(tempname(), 'a folder of Käfer''s $HOME');
    end
    [made, reason] = mkdir(folder);
    assert(made, reason);
    cleaner = onCleanup(@() remove(fileparts(folder))); %#ok<NASGU>

    numbers_of_a_motion();
    regression_of_a_table(folder);
    fits_of_a_campaign(folder);
    words_of_the_command(folder);
    missing_program();
    disp('windfall.m: all tests passed');
end

function numbers_of_a_motion()
    % A struct, with the numbers of the CSV; jsondecode of Octave rounds the last bit.
    words = {'simulate', 'impact', '--law', 'kuwabara-kono(k=753599, c=1524)', ...
        '--mass', '0.2 kg', '--velocity', '0.5 m/s'};
    impact = windfall(words{:});
    text = windfall(words{:}, '--format', 'csv');
    lines = strsplit(text, sprintf('\n'));
    columns = strsplit(lines{1}, ',');
    values = str2double(strsplit(lines{2}, ','));
    assert(same(impact.peak_force, values(strcmp(columns, 'peak_force_N'))));
    assert(same(impact.restitution, values(strcmp(columns, 'restitution'))));

    % Without --format, completions have no JSON.
    assert(ischar(windfall('completions', 'bash')));
end

function regression_of_a_table(folder)
    % The normal equations of the same table.
    velocity = [0.3; 0.3; 0.4; 0.4; 0.5; 0.5; 1 / 3];
    k = [1.10; 1.32; 1.25; 1.41; 1.38; 1.57; 0.1 + 0.2];
    file = fullfile(folder, 'a table.csv');
    handle = fopen(file, 'w', 'n', 'UTF-8');
    fprintf(handle, 'Geschwindigkeit ü,k\n');
    fprintf(handle, '%.17g,%.17g\n', [velocity, k].');
    fclose(handle);
    design = [ones(7, 1), velocity];
    estimates = design \ k;
    rest = k - design * estimates;
    covariance = (rest.' * rest / 5) * inv(design.' * design);

    [r, messages] = windfall('regress', file, '--formula', 'k ~ `Geschwindigkeit ü`');
    assert(numel(r.terms) == 2 && strcmp(r.terms(2).term, '`Geschwindigkeit ü`'));
    assert(max(abs([r.terms.estimate].' - estimates)) < 1e-9);
    assert(max(abs([r.terms.se].' - sqrt(diag(covariance)))) < 1e-9);
    assert(max(max(abs(r.covariance - covariance))) < 1e-9);
    assert(iscell(messages));

    % Numbers are passed with their digits.
    level = 0.5 + 1 / 3;
    r = windfall('summary', file, '--value', 'k', '--confidence', level);
    assert(same(r.confidence, level));
    assert(abs(r.values.groups.mean - mean(k)) < 1e-12);

    % Another level gives other limits.
    narrow = windfall('regress', file, '--formula', 'k ~ `Geschwindigkeit ü`', ...
        '--confidence', 0.9);
    wider = windfall('regress', file, '--formula', 'k ~ `Geschwindigkeit ü`');
    assert(wider.terms(2).low < narrow.terms(2).low);
end

function fits_of_a_campaign(folder)
    study = fullfile(folder, 'Früchte');
    windfall('simulate', 'pendulum', '--law', 'kuwabara-kono(k=753599, c=1524)', ...
        '--recordings', study, '--specimens', 2, '--repeats', 2, '--encoder', 'counts');
    [fitted, messages] = windfall('fit', study, '--law', 'kuwabara-kono');
    assert(numel(fitted.impacts) == 4);
    assert(any(strncmp(messages, '4 fitted', 8)));
    % One law for all: each interval of five standard deviations holds it.
    for impact = fitted.impacts(:).'
        k = impact.parameters.k;
        assert(strcmp(k.unit, 'N/m^1.5') && abs(k.value - 753599) < 5 * k.sd);
    end

    % The table that other functions read.
    table = fullfile(folder, 'fits.csv');
    windfall('fit', study, '--law', 'kuwabara-kono', '--out', table);
    handle = fopen(table, 'r', 'n', 'UTF-8');
    header = strsplit(fgetl(handle), ',');
    row = strsplit(fgetl(handle), ',');
    fclose(handle);
    value = str2double(row{strcmp(header, 'k')});
    assert(same(value, fitted.impacts(1).parameters.k.value));

    % Without a contact no laws can be compared: work that failed.
    for impact = fitted.impacts(:).'
        handle = fopen(fullfile(study, 'raw', impact.file), 'w');
        fprintf(handle, 'force_V,count\n');
        fprintf(handle, '%g,%d\n', [zeros(1, 100); 1:100]);
        fclose(handle);
    end
    [identifier, text] = caught(@() windfall('laws', study));
    assert(strcmp(identifier, 'windfall:failed'), identifier);
    assert(contains_text(text, 'there is nothing to compare'), text);
end

function words_of_the_command(folder)
    [identifier, text] = caught(@() windfall('regress', fullfile(folder, 'absent.csv'), ...
        '--formula', 'k ~ v'));
    assert(strcmp(identifier, 'windfall:request'), identifier);
    assert(contains_text(text, 'absent.csv: there is no such file'), text);
    assert(~contains_text(text, 'error: '), text);
    [identifier, text] = caught(@() windfall('summary', 'x.csv', '--valeu', 'k'));
    assert(strcmp(identifier, 'windfall:request'), identifier);
    assert(contains_text(text, 'unexpected argument ''--valeu'''), text);
    identifier = caught(@() windfall('summary', struct()));
    assert(strcmp(identifier, 'windfall:request'), identifier);
end

function missing_program()
    named = getenv('WINDFALL');
    path = getenv('PATH');
    restore = onCleanup(@() cellfun(@setenv, {'WINDFALL', 'PATH'}, {named, path})); %#ok<NASGU>
    setenv('WINDFALL', fullfile(tempdir(), 'no', 'such program'));
    [identifier, text] = caught(@() windfall('card', 'show'));
    assert(strcmp(identifier, 'windfall:missing'), identifier);
    assert(contains_text(text, 'which the environment variable WINDFALL names'), text);
    setenv('WINDFALL', '');
    setenv('PATH', tempdir());
    [identifier, text] = caught(@() windfall('card', 'show'));
    assert(strcmp(identifier, 'windfall:missing'), identifier);
    assert(contains_text(text, 'setenv('), text);
end

function [identifier, text] = caught(call)
    identifier = 'no error';
    text = '';
    try
        call();
    catch problem
        identifier = problem.identifier;
        text = problem.message;
    end
end

function equal = same(a, b)
    equal = isscalar(a) && isscalar(b) && abs(a - b) <= 4 * eps(b);
end

function found = contains_text(text, part)
    found = ~isempty(strfind(text, part));
end

function remove(folder)
    if exist('OCTAVE_VERSION', 'builtin')
        confirm_recursive_rmdir(false, 'local');
    end
    rmdir(folder, 's');
end
