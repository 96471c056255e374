#!/usr/bin/env bash
# pip installs the module from a checkout, and it works without the build tree: the network comes along.
set -euo pipefail

source_dir=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
unset PYTHONPATH

# A copy, as pip builds in the checkout; of what is committed or would be.
git -C "$source_dir" ls-files -z --cached --others --exclude-standard | tar -C "$source_dir" --null -T - -cf - | tar -C "$work" --one-top-level=checkout -xf -
/usr/bin/python3 -m venv --system-site-packages "$work/env"
"$work/env/bin/pip" install --quiet --no-build-isolation --no-index "$work/checkout"
rm -rf "$work/checkout/build" "$work/checkout/python/pcl_cosection"
cd "$work"
PYTHONPATH="$work/checkout/python/examples" "$work/env/bin/python" - << 'END'
import pcl_cosection
from simulated_table import view_of_table

assert "env" in pcl_cosection.__file__, pcl_cosection.__file__
result = pcl_cosection.complete(*view_of_table())
assert sorted(result.objects) == [1, 2] and result.objects[1].is_closed
assert result.summary["parameters"]["model"].endswith("completion.onnx"), result.summary["parameters"]["model"]
print(pcl_cosection.__version__, result)
END
"$work/env/bin/pip" uninstall --quiet --yes pcl_cosection
! "$work/env/bin/python" -c "import pcl_cosection" 2> /dev/null
