# docker build -t asset-factory . && docker run --rm -v "$PWD:/data" asset-factory build --input /data/meshes --output /data/out
FROM python:3.11-slim-bookworm

# What SAPIEN and OpenCV link against, and a compiler for what has no wheel. Debian keeps one version of each.
# hadolint ignore=DL3008
RUN apt-get update \
    && apt-get install --yes --no-install-recommends g++ git libgl1 libglib2.0-0 libx11-6 make \
    && rm -rf /var/lib/apt/lists/*

WORKDIR /opt/asset-factory
COPY . .

# A package index of your own, such as PyTorch's for machines without a GPU: --build-arg PIP_EXTRA_INDEX_URL=...
ARG PIP_EXTRA_INDEX_URL
ARG PIP_NO_CACHE_DIR=1
RUN make demo

ENV PATH=/opt/asset-factory/.venv/bin:$PATH
WORKDIR /data
ENTRYPOINT ["factory"]
CMD ["--help"]
