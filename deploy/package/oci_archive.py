"""Wraps a root folder's tar into a container image: an OCI image layout with one layer, as a tar that `docker load` and `podman load` take.

  oci_archive.py LAYER.tar OUT.tar --service chorus-sensor --version V --architecture amd64
"""

import argparse
import gzip
import hashlib
import io
import json
import shutil
import tarfile
import tempfile

PORTS = {"chorus-sensor": "8081/tcp", "chorus-fusion": "8080/tcp"}
TYPE = "application/vnd.oci.image."


def sha256(file):
    digest = hashlib.sha256()
    for block in iter(lambda: file.read(1 << 20), b""):
        digest.update(block)
    file.seek(0)
    return digest.hexdigest()


def configuration(service, version, architecture, layer_digest):
    """What runs, as whom, and where its files are; the same as the systemd unit says."""
    kind = service.removeprefix("chorus-")
    return {
        "architecture": architecture,
        "os": "linux",
        "config": {
            "User": "chorus",
            "Env": ["PATH=/usr/bin:/bin", f"STATE_DIRECTORY=/var/lib/chorus/{kind}"],
            "Entrypoint": [f"/usr/bin/{service}"],
            "Cmd": ["--config", f"/etc/chorus/{kind}.json"],
            "ExposedPorts": {PORTS[service]: {}},
            "Volumes": {"/etc/chorus": {}, f"/var/lib/chorus/{kind}": {}},
            "Labels": {"org.opencontainers.image.title": service, "org.opencontainers.image.version": version},
        },
        "rootfs": {"type": "layers", "diff_ids": [f"sha256:{layer_digest}"]},
        "history": [{"created_by": "deploy/make-image.sh"}],
    }


class Archive:
    def __init__(self, path):
        self.tar = tarfile.open(path, "w")

    def add(self, name, file, size):
        entry = tarfile.TarInfo(name)
        entry.size, entry.mode = size, 0o644
        self.tar.addfile(entry, file)

    def add_text(self, name, value):
        data = json.dumps(value).encode()
        self.add(name, io.BytesIO(data), len(data))

    def add_blob(self, kind, file, size):
        digest = sha256(file)
        self.add(f"blobs/sha256/{digest}", file, size)
        return {"mediaType": TYPE + kind, "digest": f"sha256:{digest}", "size": size}

    def add_json_blob(self, kind, value):
        data = json.dumps(value).encode()
        return self.add_blob(kind, io.BytesIO(data), len(data))


def write(arguments):
    name = f"{arguments.service}:{arguments.version.replace('+', '-')}"  # a tag has no +
    archive = Archive(arguments.out)
    with open(arguments.layer, "rb") as layer, tempfile.TemporaryFile() as packed:
        digest = sha256(layer)
        with gzip.GzipFile(fileobj=packed, mode="wb", compresslevel=6, mtime=0) as out:
            shutil.copyfileobj(layer, out)
        size = packed.tell()
        packed.seek(0)
        layer_blob = archive.add_blob("layer.v1.tar+gzip", packed, size)
    config = archive.add_json_blob("config.v1+json", configuration(arguments.service, arguments.version, arguments.architecture, digest))
    manifest = archive.add_json_blob("manifest.v1+json", {"schemaVersion": 2, "mediaType": TYPE + "manifest.v1+json", "config": config,
                                                          "layers": [layer_blob]})
    manifest["annotations"] = {"org.opencontainers.image.ref.name": name, "io.containerd.image.name": f"docker.io/library/{name}"}
    archive.add_text("index.json", {"schemaVersion": 2, "manifests": [manifest]})
    archive.add_text("oci-layout", {"imageLayoutVersion": "1.0.0"})
    # Docker before 25 reads this instead.
    path = "blobs/sha256/{}".format
    archive.add_text("manifest.json", [{"Config": path(config["digest"][7:]), "RepoTags": [name], "Layers": [path(layer_blob["digest"][7:])]}])
    archive.tar.close()
    print(f"{arguments.out}: {name}")


if __name__ == "__main__":
    parser = argparse.ArgumentParser()
    parser.add_argument("layer")
    parser.add_argument("out")
    for option in ("service", "version", "architecture"):
        parser.add_argument("--" + option, required=True)
    write(parser.parse_args())
