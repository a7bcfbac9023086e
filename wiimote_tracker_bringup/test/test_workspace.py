"""What demo, test and package share: the environment, missing packages, the workspace."""

import os
import shlex
import shutil
import subprocess

import pytest

PACKAGE = os.path.realpath(os.path.join(os.path.dirname(__file__), '..'))


@pytest.fixture(name='shell')
def shell_with_workspace(tmp_path):
    """Runs shell commands after workspace.sh. Returns what they print."""
    def shell(commands, source=PACKAGE + '/scripts/workspace.sh', folder=tmp_path, **environment):
        script = tmp_path / 'script'  # a file, since workspace.sh may start it again
        script.write_text(f'source {shlex.quote(source)}\n{commands}\n')
        return subprocess.run(['bash', str(script)], cwd=folder, check=True,
                              env=dict(os.environ, **environment), text=True,
                              stdout=subprocess.PIPE).stdout
    return shell


def test_a_path_for_cd_does_not_confuse_the_scripts(shell):
    assert shell('echo "$bringup"', 'scripts/workspace.sh', PACKAGE, CDPATH='.:/') == PACKAGE + '\n'


def test_packages_of_the_user_do_not_come_before_those_of_debian(shell):
    said = shell('python3 -c "import site; print(site.ENABLE_USER_SITE)"', PYTHONNOUSERSITE='')
    assert said == 'False\n'


@pytest.mark.skipif(not shutil.which('apt-get'), reason='this computer has no apt-get')
@pytest.mark.parametrize('release_has_it', [True, False])
def test_what_only_some_releases_have_is_installed_though_package_lists_come_first(
        shell, tmp_path, release_has_it):
    (tmp_path / 'wanted.txt').write_text('# a list\nalways\nnewer ?\n')
    said = shell("""
        not_installed() { printf '%s\\n' "$@"; }
        sudo() { true; }
        apt-cache() { [[ ! -e lists || -z $RELEASE_HAS_IT ]] || echo "$2"; }
        run() {
          local command=$*
          case $command in
            *' update') touch lists ;;
            *' install '*) echo "installs${command##*-recommends}" ;;
          esac
        }
        install_missing_packages wanted.txt""",
                 RELEASE_HAS_IT='yes' if release_has_it else '')
    assert said.splitlines()[-1] == 'installs always' + (' newer' if release_has_it else '')


@pytest.mark.parametrize('kilobytes, limit, jobs', [
    (16000000, 'max', 8), (16000000, '4000000000', 2), (4000000, '16000000000', 2),
    (16000000, '9223372036854771712', 8), (16000000, '1000000000', 1), (1000000, 'max', 1)])
def test_the_memory_of_a_container_limits_the_jobs(shell, kilobytes, limit, jobs):
    said = shell(f"""
        nproc() {{ echo 8; }}
        cat() {{ printf 'MemAvailable: {kilobytes} kB\\n{limit}\\n'; false; }}
        jobs_that_fit""")
    assert said == f'{jobs}\n'


@pytest.mark.skipif(os.geteuid() == 0, reason='root may write everywhere')
def test_a_workspace_of_another_user_is_refused(shell, tmp_path):
    (tmp_path / 'own/src').mkdir(parents=True)
    (tmp_path / 'own').chmod(0o555)
    said = shell('(prepare_workspace) 2>&1 || true',
                 WIIMOTE_TRACKER_WORKSPACE=str(tmp_path / 'own'))
    assert 'set WIIMOTE_TRACKER_WORKSPACE to a folder that can be written' in said
